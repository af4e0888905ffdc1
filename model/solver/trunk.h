#ifndef DUET_MODEL_SOLVER_TRUNK_H_
#define DUET_MODEL_SOLVER_TRUNK_H_

#include <vector>

#include "model/body/limbs.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::solver {

// Keeps hips, shoulders, head and the lean of a body within what people do. Corrections are smooth
// and are 0 in the given frames.
class Trunk {
 public:
  // `skeleton` and `body` outlive this. Requires hips, two shoulders, a chest and two legs.
  Trunk(const motion::Skeleton& skeleton, const body::Body& body);

  // Limits how far hips are turned and tilted against shoulders, and how far the head is bent.
  // Moves joints of the trunk without regard to the lengths of its bones, and limbs with them.
  void LimitTwist(double frame_rate_hz, int given, motion::Poses* poses) const;

  // Limits the lean, as its mean over about half a second: of the trunk, and of the body above its
  // feet. The feet stay where they are. `own_degrees`: how far this person may lean besides.
  void LimitLean(double frame_rate_hz, int given, double own_degrees, motion::Poses* poses) const;

  // The lean of the chest above the hips in a frame, degrees.
  double LeanDegrees(const motion::Poses& poses, int frame) const;

 private:
  motion::Vec3 HipsMiddle(absl::Span<const motion::Vec3> pose) const;
  // Rotates the line between two joints about its middle, with what hangs from them.
  void TurnLine(const motion::JointPair& pair, const std::vector<body::Limb>& limbs,
                motion::Vec3 axis, double radians, absl::Span<motion::Vec3> pose) const;
  void LimitTilt(double frame_rate_hz, int given, motion::Poses* poses) const;
  void LimitNeck(double frame_rate_hz, int given, motion::Poses* poses) const;

  const motion::Skeleton& skeleton_;
  const body::Body& body_;
  std::vector<body::Limb> arms_;  // left and right
  std::vector<bool> above_legs_;  // [joints]: not beyond the hips
};

}  // namespace duet::solver

#endif  // DUET_MODEL_SOLVER_TRUNK_H_
