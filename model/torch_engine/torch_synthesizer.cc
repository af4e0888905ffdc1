#include "model/torch_engine/torch_synthesizer.h"

#include <torch/torch.h>

#include <utility>

#include "model/checkpoint/architecture.h"
#include "model/embedded/embedded.h"
#include "model/network/exceptions.h"
#include "model/torch_engine/torch_network.h"

namespace duet::torch_engine {

absl::StatusOr<std::unique_ptr<engine::Synthesizer>> MakeTorchSynthesizer(
    const checkpoint::Checkpoint& checkpoint, const engine::PipelineOptions& options) {
  absl::StatusOr<std::unique_ptr<const engine::Network>> network = MakeTorchNetwork(checkpoint);
  if (!network.ok()) return network.status();
  const checkpoint::Manifest& manifest = checkpoint.manifest;
  return MakeSynthesizer(manifest.model, manifest.standardisation, *std::move(network), options,
                         checkpoint::CriticOf(checkpoint));
}

absl::StatusOr<std::unique_ptr<engine::Synthesizer>> LoadTorchSynthesizer(
    const std::filesystem::path& folder, const engine::PipelineOptions& options) {
  absl::StatusOr<checkpoint::Checkpoint> checkpoint = checkpoint::ReadCheckpoint(folder);
  if (!checkpoint.ok()) return checkpoint.status();
  return MakeTorchSynthesizer(*checkpoint, options);
}

absl::StatusOr<std::vector<std::unique_ptr<engine::Synthesizer>>> LoadEmbeddedSynthesizers(
    const engine::PipelineOptions& options) {
  std::vector<std::unique_ptr<engine::Synthesizer>> synthesizers;
  for (const embedded::EmbeddedCheckpoint& embedded : embedded::EmbeddedCheckpoints()) {
    absl::StatusOr<checkpoint::Checkpoint> checkpoint =
        checkpoint::ParseCheckpoint(embedded.manifest, embedded.weights);
    if (!checkpoint.ok()) return checkpoint.status();
    absl::StatusOr<std::unique_ptr<engine::Synthesizer>> synthesizer =
        MakeTorchSynthesizer(*checkpoint, options);
    if (!synthesizer.ok()) return synthesizer.status();
    synthesizers.push_back(*std::move(synthesizer));
  }
  return synthesizers;
}

absl::Status SetTorchThreads(int threads) {
  absl::Status status = network::SetThreads(threads);
  if (!status.ok()) return status;
  return network::CatchExceptions([] {
    // LibTorch allows setting this only once.
    if (torch::get_num_interop_threads() != 1) torch::set_num_interop_threads(1);
    return absl::OkStatus();
  });
}

}  // namespace duet::torch_engine
