#ifndef DUET_MODEL_CPU_ENGINE_CPU_SYNTHESIZER_H_
#define DUET_MODEL_CPU_ENGINE_CPU_SYNTHESIZER_H_

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/cpu_engine/kernels/packed_matrix.h"
#include "model/engine/network_synthesizer.h"

namespace duet::cpu_engine {

// The fastest on this processor (kernels::IsInt16Faster).
kernels::Precision BestPrecision();

// Runs a checkpoint's generator, of any architecture, in this project's own kernels.
//
// A window's answer is bit-identical whatever else is in the batch. Large batches are evaluated in
// parts, which bounds the memory of a thread; the thread keeps it for the next batch
// (ThreadScratchBytes).
std::unique_ptr<const engine::Network> MakeCpuNetwork(const checkpoint::Checkpoint& checkpoint,
                                                      kernels::Precision precision);

// Memory that the calling thread keeps for evaluations, bytes.
std::size_t ThreadScratchBytes();

struct CpuEngineOptions {
  bool as_served = true;  // see engine::MakeSynthesizer
  kernels::Precision precision = BestPrecision();
};

// A synthesizer of such a network.
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
