#ifndef DUET_MODEL_ENGINE_NETWORK_H_
#define DUET_MODEL_ENGINE_NETWORK_H_

#include <algorithm>
#include <atomic>
#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "model/engine/synthesizer.h"
#include "model/motion/poses.h"

namespace duet::engine {

// The input of a network: a window in the standard coordinates of its leader
// (windows.h), metres.
struct NetworkInput {
  motion::Poses leader;       // [frames, joints]
  int hidden_frames = 0;      // see SynthesisWindow
  std::vector<float> labels;  // [frames, classes]
  std::optional<FollowerStart> start;
  Sampling sampling;
  motion::Poses settled;  // [frames, joints], may be empty; see SynthesisWindow
  const std::atomic<bool>* cancelled = nullptr;  // see SynthesisWindow
};

inline bool IsCancelled(const NetworkInput& input) {
  return input.cancelled != nullptr && input.cancelled->load(std::memory_order_relaxed);
}
inline bool AllCancelled(absl::Span<const NetworkInput> inputs) {
  return std::all_of(inputs.begin(), inputs.end(), IsCancelled);
}

// The network of a synthesizer. An engine implements this interface. MakeSynthesizer adds
// everything around it: standard coordinates, checks, limb lengths, floor, clean-up.
//
// Threads: Run is safe to call concurrently.
class Network {
 public:
  virtual ~Network() = default;

  // Evaluates inputs of any lengths as one batch. Returns the follower of each input, in order, in
  // standard coordinates, with as many frames and joints as its leader. Values may be infinite or
  // NaN. A result does not depend on the rest of the batch (within 1e-4 m). The result of a
  // cancelled input is unspecified and need not be computed. Never throws; returns INTERNAL if
  // evaluation fails.
  virtual absl::StatusOr<std::vector<motion::Poses>> Run(
      absl::Span<const NetworkInput> inputs) const = 0;
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_NETWORK_H_
