#include "server/service/call_reactor.h"

#include <grpc/grpc.h>

#include <utility>

#include "server/common/activity.h"
#include "server/common/grpc_status.h"
#include "server/service/call_identity.h"
#include "server/service/call_pipeline.h"
#include "server/service/wire.h"

namespace duet::server::service {
namespace {

// When its deadline passes, a client resets the call. The reset can arrive before the deadline
// passes here, because the call began here later by the time that the request travelled.
constexpr double kDeadlineSlackSeconds = 0.1;

constexpr common::StepKind kReceived{"gRPC callback", "handling a request"};
constexpr common::StepKind kWritten{"gRPC callback", "writing a reply"};
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
  // Copied, because the call may end while its message is handled.
  const std::shared_ptr<Reception> reception = reception_;
  grpc::ByteBuffer bytes;
  bytes.Swap(&request_);
  if (handle_ == nullptr) {
    if (ok) {
      reception->HandOn(std::move(bytes));
    } else if (!context_.IsCancelled()) {  // OnCancel ends a cancelled call
      reception->EndOfMessages();
    }
    return;
  }
  const Handler handle = std::exchange(handle_, nullptr);
  if (!ok) {
    reception->Lost(context_.IsCancelled());
  } else if (reception->Received()) {
    handle(*this, reception, std::move(bytes));
  }
}

void CallReactor::Respond(CallScope& scope, grpc::ByteBuffer response) {
  reply_.Swap(&response);
  CallPipeline::Report(scope, absl::OkStatus(), context_);
  StartWriteAndFinish(&reply_, grpc::WriteOptions(), grpc::Status::OK);
}

void CallReactor::Run(std::shared_ptr<StreamingCall> call, std::shared_ptr<MessageSink> further) {
  const std::shared_ptr<Reception> reception = reception_;
  call_ = call;
  reception->GoOn(std::move(call), std::move(further));
}

void CallReactor::Write(const google::protobuf::Message& reply) {
  reply_ = SerializeMessage(reply);
  StartWrite(&reply_);
}

void CallReactor::Finish(CallScope& scope, const absl::Status& status) {
  if (reception_ != nullptr) reception_->Close();
  GrpcReactor& reactor = *this;
  CallPipeline::Close(scope, status, context_, reactor);
}

// Does what ServerContext::TryCancel does, with another status than CANCELLED. The status overtakes
// messages that wait for the reader.
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
