#ifndef DUET_MODEL_ENGINE_SYNTHESIZER_H_
#define DUET_MODEL_ENGINE_SYNTHESIZER_H_

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "model/engine/model_description.h"
#include "model/engine/synthesis_options.h"
#include "model/motion/poses.h"
#include "model/motion/vec3.h"

namespace duet::engine {

struct ClipRequest;  // clip_synthesis.h

// Where the follower is at a window's first frame. World metres, y up.
struct FollowerStart {
  motion::Vec3 root;
  // [joints], with pose[root joint] == root; empty when the root alone is known. One pose, not a
  // motion: hence no Poses.
  std::vector<motion::Vec3> pose;
};

// One network evaluation: at most window_frames frames at the model's frame rate and in its joint
// order. World metres, y up.
struct SynthesisWindow {
  motion::Poses leader;       // [frames, joints], 2 frames or more
  std::vector<float> labels;  // [frames, classes]
  std::optional<FollowerStart> start;
  // Horizontal direction from the leader to where the follower should be. Absent: towards `start`,
  // or else where the leader's hips face.
  std::optional<motion::Vec3> partner_direction;
  // The follower's first frames where they are settled already: [frames, joints], fewer than the
  // leader's, the first of them the start's pose. Empty: the start alone is known. A model that
  // samples goes on from them; others read the start alone.
  motion::Poses settled;
  SynthesisOptions options;
  // Set by whoever no longer wants the answer, at any time, from any thread; then it may be
  // CANCELLED before it is complete. Null: it is wanted.
  std::shared_ptr<const std::atomic<bool>> cancelled;
};

// A follower's motion for one window: [frames, joints] in the leader's world, metres, y up.
using WindowResult = absl::StatusOr<motion::Poses>;

// A loaded model: the only thing that the server knows of the network.
//
// Threads: const methods are safe to call concurrently.
class Synthesizer {
 public:
  virtual ~Synthesizer() = default;

  virtual const ModelDescription& description() const = 0;

  // Synthesises windows of any lengths together: standardise, network, inverse. Returns one result
  // for each window, in order. A window whose result is not finite fails alone, with INTERNAL, one
  // that was cancelled meanwhile with CANCELLED; an item's result does not depend on what else is
  // in the batch (within 1e-4 m).
  virtual std::vector<WindowResult> Synthesize(
      absl::Span<const SynthesisWindow* const> windows) const = 0;

  // How far a request is from what the model was trained on: 0 or more, 1 as far as the farthest
  // tenth of the training leaders. Absent where the model does not know. Takes time linear in the
  // clip's length, without running the network.
  virtual std::optional<double> Unfamiliarity(const ClipRequest& /*request*/) const {
    return std::nullopt;
  }
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_SYNTHESIZER_H_
