#include "client/client.h"

#include <utility>

#include "client/internal/connect.h"

namespace duet::client {

absl::StatusOr<Client> Client::Create(const ClientOptions& options) {
  absl::StatusOr<std::shared_ptr<Connection>> connection = internal::Connect(options);
  if (!connection.ok()) return connection.status();
  return Client(*std::move(connection));
}

absl::StatusOr<std::vector<ModelInfo>> Client::ListModels() const {
  return connection_->ListModels();
}

absl::StatusOr<ModelDetails> Client::GetModel(const ModelChoice& choice) const {
  return connection_->GetModel(choice);
}

absl::StatusOr<SynthesisResult> Client::Synthesize(const SynthesisRequest& request) const {
  return connection_->Synthesize(request, nullptr);
}

absl::StatusOr<SynthesisResult> Client::SynthesizeStreaming(const SynthesisRequest& request,
                                                            const ChunkCallback& on_chunk) const {
  return connection_->Synthesize(request, on_chunk);
}

void Client::SynthesizeAsync(SynthesisRequest request, const SynthesisCallback& done) const {
  connection_->SynthesizeAsync(std::move(request), done);
}

absl::StatusOr<std::unique_ptr<LiveSession>> Client::StartLive(const LiveRequest& request,
                                                               LiveCallbacks callbacks) const {
  return connection_->StartLive(request, std::move(callbacks));
}

}  // namespace duet::client
