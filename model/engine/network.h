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

// A window in the standard coordinates of its leader (window_standardisation.h), metres: all that a
// network sees.
struct NetworkInput {
  motion::Poses leader;       // [frames, joints]
  std::vector<float> labels;  // [frames, classes]
  std::optional<FollowerStart> start;
  Sampling sampling;
  motion::Poses settled;  // [frames, joints], perhaps none; see SynthesisWindow
  const std::atomic<bool>* cancelled = nullptr;  // see SynthesisWindow
};

inline bool IsCancelled(const NetworkInput& input) {
  return input.cancelled != nullptr && input.cancelled->load(std::memory_order_relaxed);
}
inline bool AllCancelled(absl::Span<const NetworkInput> inputs) {
  return std::all_of(inputs.begin(), inputs.end(), IsCancelled);
}

// The numbers in the middle of a synthesizer: what an engine implements. Everything around it
// (standard coordinates, checks, limb lengths, floor, clean-up) is MakeSynthesizer's.
//
// Threads: Run is safe to call concurrently.
class Network {
 public:
  virtual ~Network() = default;

  // Evaluates inputs of any lengths together. Returns each one's follower in the standard
  // coordinates, in order, of as many frames and joints as its leader; the numbers need not be
  // finite. Numbers do not depend on what else is in the batch (within 1e-4 m); those of a
  // cancelled input mean nothing, and nothing more need be computed for it. Throws nothing:
  // INTERNAL says what went wrong.
  virtual absl::StatusOr<std::vector<motion::Poses>> Run(
      absl::Span<const NetworkInput> inputs) const = 0;
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_NETWORK_H_
