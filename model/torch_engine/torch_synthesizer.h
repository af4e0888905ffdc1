#ifndef DUET_MODEL_TORCH_ENGINE_TORCH_SYNTHESIZER_H_
#define DUET_MODEL_TORCH_ENGINE_TORCH_SYNTHESIZER_H_

#include <filesystem>
#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/engine/synthesizer.h"

namespace duet::torch_engine {

struct TorchSynthesizerOptions {
  // The network works on positions, and the limbs of captured people change their lengths: give the
  // follower the limbs of its start, or else its leader's, in every frame. Off: the network's own
  // answer, for measuring the method.
  bool keep_limb_lengths = true;
  // A follower without a start is set, as a whole, on the leader's floor: both reach equally low.
  bool share_floor = true;
};

// A synthesizer that runs the generator of a checkpoint with LibTorch on the CPU.
// Threads: Synthesize is safe to call concurrently.
absl::StatusOr<std::unique_ptr<engine::Synthesizer>> MakeTorchSynthesizer(
    const checkpoint::Checkpoint& checkpoint, const TorchSynthesizerOptions& options = {});

// Reads a checkpoint folder (see ReadCheckpoint for the errors).
absl::StatusOr<std::unique_ptr<engine::Synthesizer>> LoadTorchSynthesizer(
    const std::filesystem::path& folder, const TorchSynthesizerOptions& options = {});

// The checkpoints linked into the program, the default model first.
absl::StatusOr<std::vector<std::unique_ptr<engine::Synthesizer>>> LoadEmbeddedSynthesizers(
    const TorchSynthesizerOptions& options = {});

// LibTorch's and OpenBLAS's threads for one call of Synthesize. Once, at start, before any other
// use. Workers times this should not exceed the cores: on the network's small steps two threads
// that contend are several times slower than one.
void SetTorchThreads(int threads);

}  // namespace duet::torch_engine

#endif  // DUET_MODEL_TORCH_ENGINE_TORCH_SYNTHESIZER_H_
