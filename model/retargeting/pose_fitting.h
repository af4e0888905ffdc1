#ifndef DUET_MODEL_RETARGETING_POSE_FITTING_H_
#define DUET_MODEL_RETARGETING_POSE_FITTING_H_

#include <vector>

#include "absl/types/span.h"
#include "model/motion/vec3.h"
#include "model/retargeting/rig.h"
#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// One frame as angles: each joint's rotation relative to its parent's.
struct RigPose {
  Vec3d root_position;
  std::vector<Quaternion> rotations;  // [rig joints]
  // Each joint's offset from its parent, in the parent's axes; for the root, its position.
  std::vector<Vec3d> translations;  // [rig joints]
};

// The treatment of captured bones, which change their lengths.
enum class BoneLengths {
  kRigs,     // every bone as long as the rig's: joints may be off
  kCaptured  // joints keep their captured positions: translations differ from the rig's offsets
};

// Converts joint positions to joint angles, frame by frame. Angles that a frame does not define
// (the twist of a straight arm) keep their previous value.
//
// Branching joints are rotated by Kabsch's fit over their neighbours. Every other joint is placed
// first and then points at its child, so that varying bone lengths of a capture do not accumulate
// along a limb. The plane of the elbow or knee defines the twist of the upper limb. A nearly
// straight limb keeps its plane; no bone turns about itself faster than kMaxTwist and
// kMaxTwistSpeed, and slower where a joint at one of its ends would turn faster than kMaxTurnSpeed
// against its parent. That moves no joint.
class PoseFitter {
 public:
  // Degrees per frame, and degrees per second.
  static constexpr double kMaxTwist = 40, kMaxTwistSpeed = 600;
  // Degrees per second.
  static constexpr double kMaxTurnSpeed = 850;

  // `rig` must outlive the fitter.
  PoseFitter(const Rig& rig, double frame_rate_hz, BoneLengths lengths = BoneLengths::kRigs);
  // positions: [skeleton joints], metres.
  const RigPose& Fit(absl::Span<const motion::Vec3> positions);

 private:
  Quaternion FitAim(const RigJoint& joint, Vec3d stands_at, Quaternion to_parent,
                    Quaternion previous, absl::Span<const motion::Vec3> positions) const;
  Quaternion FitBend(const RigJoint& joint, Vec3d direction, Vec3d next_bone, Quaternion swing,
                     Quaternion previous) const;
  // The rotation of rig joint j in the world, with its bone turned about itself from its direction
  // in the frame before no farther than it may.
  Quaternion LimitTwist(std::size_t j, Quaternion to_parent, Quaternion fit,
                        absl::Span<const motion::Vec3> positions) const;
  // How far rig joint j, and the one that it points at, turn against their parents; the larger.
  double LargestTurn(std::size_t j, Quaternion to_parent, Quaternion world, Vec3d next_bone) const;

  const Rig& rig_;
  const double max_twist_, max_turn_;  // per frame, radians
  const BoneLengths lengths_;
  bool first_ = true;
  RigPose pose_;
  std::vector<Quaternion> world_;  // the joints' rotations in the world. [rig joints]
  std::vector<int> aims_;          // the rig joint that a joint points at, or -1. [rig joints]
};

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_POSE_FITTING_H_
