#ifndef DUET_MODEL_SOLVER_FOLLOWER_H_
#define DUET_MODEL_SOLVER_FOLLOWER_H_

#include <memory>
#include <optional>
#include <vector>

#include "model/body/limbs.h"
#include "model/motion/pin.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/solver/body_model.h"
#include "model/solver/feet.h"
#include "model/solver/partner.h"
#include "model/solver/trunk.h"

namespace duet::solver {

// What a follower is solved for, besides the motion itself. World metres, y up.
struct Situation {
  const motion::Poses& leader;  // [frames, joints]
  int hidden_frames = 0;        // the last frames of the leader, which are a guess
  // The first frames of the follower as its caller has them, or a told pose; may be empty.
  motion::Poses given = {};
  ContactRules rules = {};  // [frames]
  motion::Pins pins = {};
};

// Makes the motion of a person out of what a network wrote: constant bones, a rigid pelvis and
// shoulders, a trunk that people can hold, feet that stand and step, knees as straight as the
// network has them, no overlap with the leader.
//
// The unknown is a correction that is added to the motion and is smooth in position, velocity and
// acceleration (SmoothCorrection), so that the timing and the amplitude of the motion stay. It is
// found group by group of coordinates: trunk, place along the floor, feet, height, hands, pins. In
// the given frames it is what leads to them.
//
// Cost:    linear in the frames; no state between calls, so that the same situation always gives
//          the same bits.
// Threads: const methods are safe to call concurrently.
class FollowerSolver {
 public:
  // Requires a skeleton that Validate accepts.
  FollowerSolver(const motion::Skeleton& skeleton, double frame_rate_hz);
  FollowerSolver(const FollowerSolver&) = delete;
  FollowerSolver& operator=(const FollowerSolver&) = delete;

  // Whether the skeleton has what Solve needs: hips, feet, two legs and two arms of two bones, and
  // a trunk between them.
  bool CanSolve() const { return trunk_.has_value(); }

  // Replaces the first frames of the follower by the given ones, and lets the others leave their
  // difference smoothly.
  void Join(const motion::Poses& given, motion::Poses* follower) const;

  // Moves the follower to pins, and nothing else.
  void MoveToPins(const motion::Pins& pins, int given, motion::Poses* follower) const;

  // Requires CanSolve(), a follower of the situation's frames that was joined, and the body to give
  // it. Leaves the given frames as they are.
  void Solve(const Situation& situation, const BodyModel& person, motion::Poses* follower) const;

 private:
  // Lowers a follower that floats, and raises one that sinks, for longer than a jump.
  void StandOnFloor(double floor, int given, motion::Poses* follower) const;
  void PlaceFeet(const Situation& situation, const Stretches& stretches,
                 motion::Poses* follower) const;
  // Where knees and elbows point: [limbs_], each [frames, 1].
  std::vector<motion::Poses> SmoothBends(const motion::Poses& follower) const;
  void BendLimbs(const std::vector<motion::Poses>& bends, int given, motion::Poses* follower) const;
  // The height of a standing foot, and how far the person leans in the given frames.
  double FloorOf(const Situation& situation) const;
  double OwnLean(const Situation& situation) const;

  const motion::Skeleton skeleton_;
  const double frame_rate_hz_;
  const body::Body body_;
  std::optional<Trunk> trunk_;
  std::vector<body::Limb> limbs_;  // legs, then arms
};

// Keeps the feet of a frame between two planned ones on the straight way between their places:
// splines overshoot. Shapes: all [joints].
void KeepFeetBetween(const body::Body& body, absl::Span<const motion::Vec3> before,
                     absl::Span<const motion::Vec3> after, absl::Span<motion::Vec3> pose);

// Moves a follower that stands in its leader along the floor: one that jumped there after the plan
// was made. Shapes: both [joints].
void KeepApart(int root, absl::Span<const motion::Vec3> leader, absl::Span<motion::Vec3> follower);

}  // namespace duet::solver

#endif  // DUET_MODEL_SOLVER_FOLLOWER_H_
