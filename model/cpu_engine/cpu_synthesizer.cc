#include "model/cpu_engine/cpu_synthesizer.h"

#include <utility>

#include "model/checkpoint/architecture.h"
#include "model/embedded/embedded.h"

namespace duet::cpu_engine {

std::unique_ptr<engine::Synthesizer> MakeCpuSynthesizer(const checkpoint::Checkpoint& checkpoint,
                                                        const CpuEngineOptions& options) {
  return MakeSynthesizer(checkpoint.manifest.model, checkpoint.manifest.standardisation,
                         MakeCpuNetwork(checkpoint, options.precision), options.pipeline,
                         checkpoint::CriticOf(checkpoint));
}

absl::StatusOr<std::unique_ptr<engine::Synthesizer>> LoadCpuSynthesizer(
    const std::filesystem::path& folder, const CpuEngineOptions& options) {
  absl::StatusOr<checkpoint::Checkpoint> checkpoint = checkpoint::ReadCheckpoint(folder);
  if (!checkpoint.ok()) return checkpoint.status();
  return MakeCpuSynthesizer(*checkpoint, options);
}

absl::StatusOr<std::vector<std::unique_ptr<engine::Synthesizer>>> LoadEmbeddedSynthesizers(
    const CpuEngineOptions& options) {
  std::vector<std::unique_ptr<engine::Synthesizer>> synthesizers;
  for (const embedded::EmbeddedCheckpoint& embedded : embedded::EmbeddedCheckpoints()) {
    absl::StatusOr<checkpoint::Checkpoint> checkpoint =
        checkpoint::ParseCheckpoint(embedded.manifest, embedded.weights);
    if (!checkpoint.ok()) return checkpoint.status();
    synthesizers.push_back(MakeCpuSynthesizer(*checkpoint, options));
  }
  return synthesizers;
}

}  // namespace duet::cpu_engine
