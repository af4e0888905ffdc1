#include "server/service/synthesize_reactor.h"

#include <chrono>
#include <utility>

#include "server/service/call_pipeline.h"
#include "server/service/wire.h"

namespace duet::server::service {
namespace {

// A client whose deadline passes resets the call; that may arrive a little before the deadline
// passes here, where it began later by the request's way.
constexpr std::chrono::milliseconds kDeadlineSlack(100);

}  // namespace

void SynthesizeReactor::Run(std::shared_ptr<SynthesisCall> call) {
  call_ = std::move(call);
  call_->Start();
}

void SynthesizeReactor::Write(const v1::SynthesizeResponse& reply) {
  reply_ = SerializeMessage(reply);
  StartWrite(&reply_);
}

void SynthesizeReactor::Finish(CallScope& scope, const absl::Status& status) {
  grpc::ServerWriteReactor<grpc::ByteBuffer>& reactor = *this;
  CallPipeline::Close(scope, status, context_, reactor);
}

void SynthesizeReactor::OnCancel() {
  if (call_ == nullptr) return;
  const bool expired = std::chrono::system_clock::now() + kDeadlineSlack >= context_.deadline();
  call_->Abort(expired ? absl::DeadlineExceededError("the call's deadline passed")
                       : absl::CancelledError("the caller cancelled"));
}

}  // namespace duet::server::service
