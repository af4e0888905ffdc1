#include "server/service/synthesize_reactor.h"

#include <chrono>
#include <utility>

#include "server/service/grpc_status.h"

namespace duet {

void SynthesizeReactor::Run(std::shared_ptr<SynthesisCall> call) {
  call_ = std::move(call);
  call_->Start();
}

void SynthesizeReactor::Finish(const absl::Status& status) {
  AddRetryPushback(status, context_);
  grpc::ServerWriteReactor<v1::SynthesizeResponse>::Finish(ToGrpcStatus(status));
}

void SynthesizeReactor::OnCancel() {
  if (call_ == nullptr) return;
  const bool expired = std::chrono::system_clock::now() >= context_.deadline();
  call_->Abort(expired ? absl::DeadlineExceededError("the call's deadline passed")
                       : absl::CancelledError("the caller cancelled"));
}

}  // namespace duet
