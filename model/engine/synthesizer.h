#ifndef DUET_MODEL_ENGINE_SYNTHESIZER_H_
#define DUET_MODEL_ENGINE_SYNTHESIZER_H_

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "model/engine/model_description.h"
#include "model/motion/pin.h"
#include "model/motion/poses.h"
#include "model/motion/vec3.h"

namespace duet::engine {

inline constexpr int kMostCandidates = 16, kDefaultCandidates = 1;
inline constexpr float kMostReaction = 2;

// Selects the sample that a sampling model draws. Models that do not sample
// (ModelDescription::samples) ignore it.
struct Sampling {
  // On the same engine, the same request with the same seed returns the same motion.
  uint64_t seed = 0;
  // In [0, 2]. 0: the typical motion; 1: as varied as the captured motion.
  float variety = 1;
  // Number of samples that are drawn for each window, in [1, kMostCandidates]; the best one is
  // returned (candidates.h).
  int candidates = kDefaultCandidates;
  // How much the leader's motion moves the follower, in [0, kMostReaction]: a factor of the
  // difference from the answer to a leader who stands still (mixture.h). Other values than 1 take
  // twice the evaluations.
  float reaction = 1;
  // Set for a window of an endless motion: the index of the window's first frame in it. The noise
  // of a frame is then the same in every window that contains the frame (frame_noise.h).
  std::optional<int64_t> first_frame = std::nullopt;
};

// What a caller chooses beyond leader, labels and start. The validator fills it in; ClipSynthesis
// copies it into every window. docs/guides/add_a_request_field.md describes how to add a field.
struct SynthesisOptions {
  Sampling sampling;
  // Whether to make a body of the follower (model/solver). Absent: the default of the server or of
  // the model (ModelDescription::cleaned_up_by_default).
  std::optional<bool> clean_up;
};

struct ClipRequest;  // clip_synthesis.h

// The follower at a window's first frame. World metres, y up.
struct FollowerStart {
  motion::Vec3 root;
  // [joints], with pose[root joint] == root. Empty if only the root is known.
  std::vector<motion::Vec3> pose;
};

// One network evaluation: at most window_frames frames at the model's frame rate and in its joint
// order. World metres, y up.
struct SynthesisWindow {
  motion::Poses leader;  // [frames, joints], 2 frames or more
  // The number of frames at the window's end in which the leader is a guess, because the true
  // motion is not known yet. 0 for clips.
  int hidden_frames = 0;
  std::vector<float> labels;  // [frames, classes]
  std::optional<FollowerStart> start;
  // Horizontal direction from the leader to the follower. Absent: towards `start`; without a start,
  // the direction in which the leader's hips face.
  std::optional<motion::Vec3> partner_direction;
  // The first frames of the follower that are final: [frames, joints], fewer than the leader's. The
  // first of them is the start's pose. Empty: only the start is known. Sampling models continue
  // from these frames; others read only the start.
  motion::Poses settled;
  // The frames after the settled ones that the caller already has. The network makes them anew, and
  // the follower continues from the last of them. Empty for clips.
  motion::Poses sent;
  // Where joints of the follower must be, in the window's frames. Those in settled frames have no
  // effect; those soon after the last frame are prepared for.
  motion::Pins pins = {};
  SynthesisOptions options;
  // Set, at any time and from any thread, when the result is not needed any more. The result may
  // then be CANCELLED. Null: never cancelled.
  std::shared_ptr<const std::atomic<bool>> cancelled;
};

// A follower's motion for one window: [frames, joints] in the leader's world, metres, y up.
using WindowResult = absl::StatusOr<motion::Poses>;

// A loaded model. The server sees the network only through this interface.
//
// Threads: const methods are safe to call concurrently.
class Synthesizer {
 public:
  virtual ~Synthesizer() = default;

  virtual const ModelDescription& description() const = 0;

  // Synthesizes windows of any lengths as one batch: standardise, network, inverse. Returns one
  // result for each window, in order. A window whose result is not finite fails with INTERNAL, and
  // a window that was cancelled with CANCELLED; the others are not affected. A result does not
  // depend on the rest of the batch (within 1e-4 m).
  virtual std::vector<WindowResult> Synthesize(
      absl::Span<const SynthesisWindow* const> windows) const = 0;

  // Returns the distance of a request's leader from the model's training data, at least 0. A tenth
  // of the training leaders have a distance above 1. Absent if the model has no statistics of its
  // training data. Does not run the network; takes time linear in the clip's length.
  virtual std::optional<double> Unfamiliarity(const ClipRequest& /*request*/) const {
    return std::nullopt;
  }
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_SYNTHESIZER_H_
