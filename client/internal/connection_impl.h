#ifndef DUET_CLIENT_INTERNAL_CONNECTION_IMPL_H_
#define DUET_CLIENT_INTERNAL_CONNECTION_IMPL_H_

#include <memory>
#include <string>
#include <vector>

#include "client/connection.h"
#include "client/internal/reply_assembler.h"
#include "client/internal/retry.h"
#include "client/internal/stub.h"
#include "client/options.h"

namespace duet::client::internal {

// Makes calls through a stub: converts values to protos and back, sets the deadline, retries, and
// validates the replies.
class ConnectionImpl final : public Connection {
 public:
  ConnectionImpl(std::shared_ptr<Stub> stub, const ClientOptions& options,
                 RetryEnvironment environment = SystemEnvironment());

  absl::StatusOr<std::vector<ModelInfo>> ListModels() override;
  absl::StatusOr<ModelDetails> GetModel(const ModelChoice& choice) override;
  absl::StatusOr<SynthesisResult> Synthesize(const SynthesisRequest& request,
                                             const ChunkCallback& on_chunk) override;
  void SynthesizeAsync(SynthesisRequest request, const SynthesisCallback& done) override;
  absl::StatusOr<std::unique_ptr<LiveSession>> StartLive(const LiveRequest& request,
                                                         LiveCallbacks callbacks) override;

 private:
  RetryLimits Limits(const CallContext& call) const;
  absl::Status RunStream(const CallContext& call, const v1::SynthesizeRequest& request,
                         ReplyAssembler* reply, absl::Time* first_chunk);
  absl::Time Deadline() const { return environment_.now() + deadline_; }

  std::shared_ptr<Stub> stub_;
  absl::Duration deadline_, wait_;
  std::string server_address_;
  RetryOptions retry_;
  RetryEnvironment environment_;
};

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_CONNECTION_IMPL_H_
