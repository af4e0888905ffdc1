#ifndef DUET_MODEL_CLEANUP_PINS_H_
#define DUET_MODEL_CLEANUP_PINS_H_

#include <vector>

#include "model/body/limbs.h"
#include "model/cleanup/limb_pins.h"
#include "model/cleanup/timing.h"
#include "model/motion/pin.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

struct PinOptions {
  // The shortest time before and after a pin in which its correction comes and goes.
  double ease_seconds = 0.35;
  // Longer corrections take longer, so that the joint is not faster than this because of them.
  double gentle_metres_per_second = 1.5, gentle_body_metres_per_second = 0.8;
  // If there is less time, after settled frames or between two pins, the correction is shortened so
  // that it is not faster than this.
  double fastest_metres_per_second = 4, fastest_body_metres_per_second = 1.6;
  // How far the body moves at most for a limb that is too short, and for a pin of its own.
  double farthest_approach_metres = 1, farthest_body_metres = 3;
  // How far the body rises or sinks at most: a person can crouch or stand on their toes.
  float farthest_lift_metres = 0.3f;
  // How far the heel of a standing foot rises at most so that a pinned body gets farther from it.
  float highest_heel_metres = 0.06f;
};

// Moves the joints of a follower to their pins, and eases the corrections in and out over the
// neighbouring frames. Rotates the limb of a pinned hand, foot, elbow or knee; moves the whole body
// for every other joint, and if a limb is too short. Preserves bone lengths, and never changes
// settled frames: pins in them have no effect. A joint that cannot get to its pin gets as close as
// it can.
//
// In two steps, with the stages that place the feet between them: Approach moves the body, so that
// the feet step with it; Place moves the limbs, and the body above its standing feet.
//
//   PinnedMotion pinned(skeleton, body, pins, options, timing, *follower);
//   pinned.Approach(follower);
//   ... move bodies apart ...
//   pinned.HoldBody(*follower);
//   ... place the feet ...
//   pinned.Place(keep_ranges, follower);
//
// Cost:    linear in the frames and in the pins.
// Threads: not safe to call concurrently.
class PinnedMotion {
 public:
  // Requires pins of the skeleton's joints; skeleton and body outlive this. `follower`: the motion
  // without pins, from which their softness counts.
  PinnedMotion(const motion::Skeleton& skeleton, const body::Body& body, const motion::Pins& pins,
               const PinOptions& options, const Timing& timing, const motion::Poses& follower);

  // Returns whether the body moved.
  bool Approach(motion::Poses* follower) const;
  // Lets the pins of the body be where the body is now: what moved it away from them has priority.
  void HoldBody(const motion::Poses& follower);
  // `keep_ranges` limits the joints of limbs that move; may be empty.
  void Place(const KeepRanges& keep_ranges, motion::Poses* follower) const;

 private:
  Timing timing_;
  const motion::Skeleton& skeleton_;
  const body::Body& body_;
  PinOptions options_;
  motion::Pins body_pins_;               // by frame; of joints that only the whole body moves
  std::vector<motion::Pins> limb_pins_;  // [limbs], each by joint and frame: legs, then arms
};

// Returns the mean distance between the pins and their joints in the frames of `follower` from
// `settled` on, metres; 0 if there are none.
double MeanPinDistance(const motion::Pins& pins, const motion::Poses& follower, int settled);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_PINS_H_
