#ifndef DUET_MODEL_CPU_ENGINE_CPU_SYNTHESIZER_H_
#define DUET_MODEL_CPU_ENGINE_CPU_SYNTHESIZER_H_

#include <filesystem>
#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/cpu_engine/cpu_network.h"
#include "model/engine/network_synthesizer.h"

namespace duet::cpu_engine {

struct CpuEngineOptions {
  engine::PipelineOptions pipeline = {};
  kernels::Precision precision = BestPrecision();
};

std::unique_ptr<engine::Synthesizer> MakeCpuSynthesizer(const checkpoint::Checkpoint& checkpoint,
                                                        const CpuEngineOptions& options = {});

// Reads a checkpoint folder. Errors: those of ReadCheckpoint.
absl::StatusOr<std::unique_ptr<engine::Synthesizer>> LoadCpuSynthesizer(
    const std::filesystem::path& folder, const CpuEngineOptions& options = {});

// Synthesizers of the embedded checkpoints, the default model first.
absl::StatusOr<std::vector<std::unique_ptr<engine::Synthesizer>>> LoadEmbeddedSynthesizers(
    const CpuEngineOptions& options = {});

}  // namespace duet::cpu_engine

#endif  // DUET_MODEL_CPU_ENGINE_CPU_SYNTHESIZER_H_
