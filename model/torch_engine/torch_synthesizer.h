#ifndef DUET_MODEL_TORCH_ENGINE_TORCH_SYNTHESIZER_H_
#define DUET_MODEL_TORCH_ENGINE_TORCH_SYNTHESIZER_H_

#include <filesystem>
#include <memory>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/engine/network_synthesizer.h"
#include "model/engine/synthesizer.h"

namespace duet::torch_engine {

// A synthesizer that runs the generator of a checkpoint with LibTorch on the CPU.
// Threads: Synthesize is safe to call concurrently.
absl::StatusOr<std::unique_ptr<engine::Synthesizer>> MakeTorchSynthesizer(
    const checkpoint::Checkpoint& checkpoint, const engine::PipelineOptions& options = {});

// Reads a checkpoint folder (see ReadCheckpoint for the errors).
absl::StatusOr<std::unique_ptr<engine::Synthesizer>> LoadTorchSynthesizer(
    const std::filesystem::path& folder, const engine::PipelineOptions& options = {});

// The checkpoints linked into the program, the default model first.
absl::StatusOr<std::vector<std::unique_ptr<engine::Synthesizer>>> LoadEmbeddedSynthesizers(
    const engine::PipelineOptions& options = {});

// LibTorch's and OpenBLAS's threads for one call of Synthesize. Once, at start, before any other
// use. Workers times this should not exceed the cores: on the network's small steps two threads
// that contend are several times slower than one. INTERNAL where LibTorch cannot find out about the
// processor.
absl::Status SetTorchThreads(int threads);

}  // namespace duet::torch_engine

#endif  // DUET_MODEL_TORCH_ENGINE_TORCH_SYNTHESIZER_H_
