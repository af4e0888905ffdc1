#include "server/service/call_reactor.h"

#include <grpc/grpc.h>

#include <utility>

#include "server/common/activity.h"
#include "server/common/grpc_status.h"
#include "server/service/call_deadline.h"
#include "server/service/call_pipeline.h"
#include "server/service/wire.h"

namespace duet::server::service {
namespace {

// A client whose deadline passes resets the call; that may arrive a little before the deadline
// passes here, where it began later by the request's way.
constexpr double kDeadlineSlackSeconds = 0.1;

constexpr common::StepKind kReceived{"gRPC callback", "handling a request"};
constexpr common::StepKind kWritten{"gRPC callback", "writing an answer"};
constexpr common::StepKind kCancelled{"gRPC callback", "ending a cancelled call"};

using GrpcReactor = grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>;

}  // namespace

void CallReactor::Receive(std::shared_ptr<Reception> reception, Handler handle) {
  reception_ = std::move(reception);
  handle_ = std::move(handle);
  StartRead(&request_);
}

void CallReactor::OnReadDone(bool ok) {
  const common::Step step(kReceived);
  // The answer may come, and this reactor go, while it is being handled.
  const std::shared_ptr<Reception> reception = reception_;
  if (!ok) {
    reception->Lost(context_.IsCancelled());
  } else if (reception->Received()) {
    grpc::ByteBuffer bytes;
    bytes.Swap(&request_);
    const Handler handle = std::move(handle_);
    handle(*this, reception, std::move(bytes));
  }
}

void CallReactor::Respond(CallScope& scope, grpc::ByteBuffer response) {
  reply_.Swap(&response);
  CallPipeline::Report(scope, absl::OkStatus(), context_);
  StartWriteAndFinish(&reply_, grpc::WriteOptions(), grpc::Status::OK);
}

void CallReactor::Run(std::shared_ptr<SynthesisCall> call) {
  const std::shared_ptr<Reception> reception = reception_;
  call_ = call;
  reception->GoOn(std::move(call));
}

void CallReactor::Write(const v1::SynthesizeResponse& reply) {
  reply_ = SerializeMessage(reply);
  StartWrite(&reply_);
}

void CallReactor::Finish(CallScope& scope, const absl::Status& status) {
  GrpcReactor& reactor = *this;
  CallPipeline::Close(scope, status, context_, reactor);
}

// What ServerContext::TryCancel does, with a status of the server's instead of CANCELLED. gRPC
// writes it past the messages that wait for the reader.
void CallReactor::BreakOff(const absl::Status& reason) {
  const grpc::Status status = common::ToGrpcStatus(reason);
  grpc_call_cancel_with_status(context_.c_call(),
                               static_cast<grpc_status_code>(status.error_code()),
                               status.error_message().c_str(), nullptr);
}

void CallReactor::OnWriteDone(bool ok) {
  const common::Step step(kWritten);
  call_->OnWritten(ok);
}

void CallReactor::OnCancel() {
  const common::Step step(kCancelled);
  if (reception_ == nullptr) return;
  const bool expired = SecondsLeft(context_) <= kDeadlineSlackSeconds;
  reception_->Abort(expired ? absl::DeadlineExceededError("the call's deadline passed")
                            : absl::CancelledError("the caller cancelled"));
}

}  // namespace duet::server::service
