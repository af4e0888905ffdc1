#ifndef DUET_MODEL_TORCH_ENGINE_TORCH_SYNTHESIZER_H_
#define DUET_MODEL_TORCH_ENGINE_TORCH_SYNTHESIZER_H_

#include <filesystem>
#include <memory>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/engine/network_synthesizer.h"

namespace duet::torch_engine {

// Runs the generator of a checkpoint, of any architecture, with LibTorch on the CPU.
// INVALID_ARGUMENT names a tensor that is missing or has another shape. LibTorch's exceptions
// become INTERNAL.
absl::StatusOr<std::unique_ptr<const engine::Network>> MakeTorchNetwork(
    const checkpoint::Checkpoint& checkpoint);

// A synthesizer of such a network.
// Threads: Synthesize is safe to call concurrently.
absl::StatusOr<std::unique_ptr<engine::Synthesizer>> MakeTorchSynthesizer(
    const checkpoint::Checkpoint& checkpoint, const engine::PipelineOptions& options = {});

// Reads a checkpoint folder (see ReadCheckpoint for the errors).
absl::StatusOr<std::unique_ptr<engine::Synthesizer>> LoadTorchSynthesizer(
    const std::filesystem::path& folder, const engine::PipelineOptions& options = {});

// Synthesizers of the embedded checkpoints, the default model first.
absl::StatusOr<std::vector<std::unique_ptr<engine::Synthesizer>>> LoadEmbeddedSynthesizers(
    const engine::PipelineOptions& options = {});

// Sets the threads of LibTorch and OpenBLAS for one call of Synthesize. Call it once, before any
// other use of LibTorch. The number of workers times `threads` should not exceed the cores: with
// the small steps of these networks, two contending threads are several times slower than one.
// INTERNAL if LibTorch cannot identify the processor.
absl::Status SetTorchThreads(int threads);

}  // namespace duet::torch_engine

#endif  // DUET_MODEL_TORCH_ENGINE_TORCH_SYNTHESIZER_H_
