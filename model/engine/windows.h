#ifndef DUET_MODEL_ENGINE_WINDOWS_H_
#define DUET_MODEL_ENGINE_WINDOWS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "model/engine/model_description.h"
#include "model/engine/network.h"
#include "model/engine/synthesizer.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/standardise.h"
#include "model/motion/vec3.h"

namespace duet::engine {

// How a long clip is cut into overlapping windows for a network that was trained on short ones. All
// windows have the same length and are spread evenly, so that no short remainder is left at the
// end. The first starts at 0, the last ends with the clip.
struct WindowPlan {
  int length = 0;           // frames of every window
  std::vector<int> starts;  // strictly increasing
};

// Returns the number of frames, at least 1, that neighbouring windows of `window` frames share if
// each window is independent: long enough for an invisible cross-fade, short enough to add only
// half of the cost.
int CrossFadeOverlap(int window);

// Returns the same if a window continues from frames that the previous one settled: long enough to
// carry pose, speed and the start of a movement (half a second for the embedded models).
int SettledOverlap(int window);

// Plans the fewest windows of at most `longest` frames that cover `frames`, neighbours sharing at
// least `overlap` frames. Requires `frames` and `longest` >= 2, and 1 <= `overlap` < `longest`.
WindowPlan PlanWindows(int frames, int longest, int overlap);

// Blends one motion into another over the frames that they share, preserving limb lengths.
//
// Averaging two poses joint by joint shortens every limb whose direction differs between them.
// Therefore only the root is averaged, and each bone gets the average direction and length.
class CrossFade {
 public:
  // Requires a skeleton that Validate accepts.
  explicit CrossFade(const motion::Skeleton& skeleton);

  // Replaces the frames of `poses` from `first` on by a smooth blend from `poses` to `next`, whose
  // frame 0 corresponds to `first`. The first blended frame contains some of `next`, the last some
  // of `poses`. Requires `next` to have at least as many frames.
  void Blend(const motion::Poses& next, int first, motion::Poses* poses) const;

 private:
  void BlendPose(absl::Span<const motion::Vec3> next, float weight,
                 absl::Span<motion::Vec3> pose) const;

  std::size_t root_;
  std::vector<motion::Bone> bones_;  // parents before their children
};

// What a synthesis in overlapping windows carries from one window to the next: the number of
// windows so far, and the follower's frames that later windows may still change or continue from.
// Frames are counted at the model's rate from the first frame of the first window.
//
// Cost:    memory of the frames that are kept.
// Threads: not safe to call concurrently.
class WindowState {
 public:
  explicit WindowState(int joints) : follower_(0, joints) {}

  int window_count() const { return window_count_; }

  // The frames that are kept: [begin(), end()). Frame `begin()` is follower()[0].
  int begin() const { return begin_; }
  int end() const { return begin_ + follower_.frame_count(); }
  const motion::Poses& follower() const { return follower_; }

  // Adds the follower of a window that begins at frame `start`, in [begin(), end()]. The frames
  // that it shares with follower() are cross-faded. Requires `window` to reach end() or beyond.
  void Add(int start, const motion::Poses& window, const CrossFade& cross_fade);

  // Drops the frames from `frame` on, so that the next window answers them again.
  void DropFrom(int frame);

  // Drops the frames before `frame`. Does nothing if they were dropped already.
  void DropBefore(int frame);

 private:
  int window_count_ = 0;
  int begin_ = 0;
  motion::Poses follower_;  // blended
};

// True if each window of the model continues from frames that the window before it settled, rather
// than from their first pose only. Another sample would be another motion.
bool ContinuesFromSettledFrames(const ModelDescription& model);

// Number of frames that neighbouring windows of the model share.
int WindowOverlap(const ModelDescription& model);

// Sets the fields of `window`, which begins at frame `frame`, that continue the follower so far, as
// far as the model uses them: `start` and `settled`. Requires `frame` in [begin(), end()).
void ContinueFrom(const WindowState& state, int frame, const ModelDescription& model,
                  SynthesisWindow* window);

// Returns the seed of a window (0 is the first) of a clip that was requested with `seed`. The first
// window has `seed` itself, so that a clip of one window equals the network's own result. Later
// windows have different seeds, which practically never coincide with those of another request.
//
// Source: Steele, Lea, Flood 2014 (SplitMix64): the window-th number of the stream that starts with
// `seed`. The same on every machine. Changing it changes the results of all long clips.
uint64_t WindowSeed(uint64_t seed, int window);

// Returns the seed of a clip whose caller names none: one that differs between leaders, so that
// their followers are different people. It depends on the clip's length and on how far its joints
// move, both rounded, so that another unit or place in the world hardly ever changes it. One of
// `seeds`, or a number below 2^32 if that is empty. Units: metres.
uint64_t LeaderSeed(const motion::Poses& leader, double frame_rate_hz,
                    const std::vector<uint64_t>& seeds);

// Returns the coordinates in which the network sees a window, in training and in service. The
// leader's root is at the origin (in every frame, or in the first one). -z points towards the
// follower: along the window's partner direction; else towards the follower's start, unless both
// are at nearly the same position; else in the direction of the leader's hips. A leader without
// hips is not turned.
motion::Standardisation WindowStandardisation(
    const motion::Skeleton& skeleton, const SynthesisWindow& window,
    motion::StandardOrigin origin = motion::StandardOrigin::kEveryFrame);

// Converts a window to the standard coordinates of its leader. The follower's start is relative to
// the leader's first root position.
NetworkInput Standardise(const motion::Standardisation& standardisation,
                         const SynthesisWindow& window);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_WINDOWS_H_
