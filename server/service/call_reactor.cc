#include "server/service/call_reactor.h"

#include <grpc/grpc.h>
#include <grpcpp/impl/codegen/server_callback_handlers.h>
#include <grpcpp/impl/rpc_method.h>
#include <grpcpp/impl/rpc_service_method.h>

#include <utility>

#include "server/common/grpc_status.h"
#include "server/service/call_pipeline.h"
#include "server/service/wire.h"

namespace duet::server::service {
namespace {

// When its deadline passes, a client resets the call. The reset can arrive before the deadline
// passes here, because the call began here later by the time that the request travelled.
constexpr double kDeadlineSlackSeconds = 0.1;

using GrpcReactor = grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>;

}  // namespace

// Does what the constructors of generated services do. gRPC itself serves unary methods as streams
// this way (grpc::Service::MarkMethodStreamed).
void RawService::Serve(const char* method,
                       std::function<Reactor*(grpc::CallbackServerContext*)> open) {
  using grpc::internal::CallbackBidiHandler;
  using grpc::internal::RpcMethod;
  using grpc::internal::RpcServiceMethod;
  AddMethod(new RpcServiceMethod(method, RpcMethod::BIDI_STREAMING, nullptr));
  MarkMethodRawCallback(methods_++,
                        new CallbackBidiHandler<grpc::ByteBuffer, grpc::ByteBuffer>(
                            [open = std::move(open)](grpc::CallbackServerContext* context) {
                              return open(context);
                            }));
}

void CallReactor::Receive(std::shared_ptr<Call> call, Handler handle) {
  call_ = std::move(call);
  handle_ = std::move(handle);
  StartRead(&request_);
}

void CallReactor::OnReadDone(bool ok) {
  // Copied, because the call may end while its message is handled.
  const std::shared_ptr<Call> call = call_;
  grpc::ByteBuffer bytes;
  bytes.Swap(&request_);
  if (handle_ == nullptr) {
    if (ok) {
      call->OnMessage(std::move(bytes));
    } else if (!context_.IsCancelled()) {  // OnCancel ends a cancelled call
      call->OnEndOfMessages();
    }
    return;
  }
  const Handler handle = std::exchange(handle_, nullptr);
  if (!ok) {
    call->OnNoMessage(context_.IsCancelled());
  } else if (call->OnFirstMessage()) {
    handle(*this, call, std::move(bytes));
  }
}

void CallReactor::Respond(CallScope& scope, grpc::ByteBuffer response) {
  reply_.Swap(&response);
  CallPipeline::Report(scope, absl::OkStatus(), context_);
  StartWriteAndFinish(&reply_, grpc::WriteOptions(), grpc::Status::OK);
}

void CallReactor::Write(const google::protobuf::Message& reply) {
  reply_ = SerializeMessage(reply);
  StartWrite(&reply_);
}

void CallReactor::Finish(CallScope& scope, const absl::Status& status) {
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

void CallReactor::OnWriteDone(bool ok) { call_->OnWritten(ok); }

void CallReactor::OnCancel() {
  if (call_ == nullptr) return;
  const bool expired = SecondsLeft(context_) <= kDeadlineSlackSeconds;
  call_->Abort(expired ? absl::DeadlineExceededError("the call's deadline passed")
                       : absl::CancelledError("the caller cancelled"));
}

}  // namespace duet::server::service
