#ifndef DUET_MODEL_CLEANUP_LIVE_BOUNDS_H_
#define DUET_MODEL_CLEANUP_LIVE_BOUNDS_H_

#include "model/body/limbs.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

// Bounds for a motion without an end. Every window of it plans a return to normal, which the next
// window postpones. The other stages permit short violations and look ahead for their end; these
// bounds depend only on the frame and on what was sent before it.
struct LiveBoundOptions {
  // The more the trunk leaned in the last second, the less it may lean now. After a mean of
  // easy_degrees or less it may lean by bow_degrees, after one of lasting_degrees or more by
  // upright_degrees.
  double easy_degrees = 8, lasting_degrees = 17, upright_degrees = 13, bow_degrees = 60;
  double lasting_seconds = 1;
  // Horizontal distance of the roots, metres: within the inner values nothing is corrected, beyond
  // the outer ones no follower stays for long.
  double near_metres = 0.3, nearest_metres = 0.18;
  double far_metres = 2.3, farthest_metres = 2.65;
  // Height of the lower foot above or below the floor, metres.
  double low_metres = 0.018, lowest_metres = 0.036;
  // Maximum speed of the corrections of the whole body, so that it is not dragged after a leader
  // who jumps.
  double fastest_metres_per_second = 2;
};

// Keeps a live follower within its bounds. All methods leave the settled frames unchanged, which
// are the ones that the caller has.
//
// Shapes:  `leader` like the follower. At least one frame.
// Threads: const methods are safe to call concurrently.
class LiveBounds {
 public:
  // Requires a skeleton that Validate accepts.
  explicit LiveBounds(const motion::Skeleton& skeleton, const LiveBoundOptions& options = {});

  // Before the feet are placed: lean and distance. Bends a trunk at the hips, and moves the body
  // along the floor.
  void BoundBody(const motion::Poses& leader, const Timing& timing, motion::Poses* follower) const;
  // Afterwards: moves the body vertically. The leader defines the floor, in any frames, at least
  // one. Does nothing for a skeleton without feet.
  void BoundFeet(const motion::Poses& leader, const Timing& timing, motion::Poses* follower) const;

 private:
  void LimitLean(const Timing& timing, motion::Poses* follower) const;
  void LimitDistance(const motion::Poses& leader, const Timing& timing,
                     motion::Poses* follower) const;
  // The largest lean of the trunk, radians, after one of `mean` degrees on average.
  float AllowedLean(double mean) const;
  // A distance within the bounds; nearly the same if it is well inside.
  float AllowedDistance(float distance) const;
  // Lowers a foot that leaves the floor while the other one comes down: between the two frames,
  // both would be in the air.
  void LowerRisingFoot(float floor, int frame, motion::Poses* follower) const;
  // How far a correction of the whole body may have come in a frame, metres.
  float Way(const Timing& timing, int frame) const;

  motion::Skeleton skeleton_;
  LiveBoundOptions options_;
  body::Body body_;
};

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_LIVE_BOUNDS_H_
