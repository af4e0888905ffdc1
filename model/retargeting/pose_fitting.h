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
  // Where each joint is from its parent, in its parent's axes; the root's is its position.
  std::vector<Vec3d> translations;  // [rig joints]
};

// Captured bones change their lengths.
enum class BoneLengths {
  kRigs,     // every bone as long as the rig's: joints may be off
  kCaptured  // joints stand where they were captured: translations differ from the rig's offsets
};

// From joint positions to joint angles, frame after frame; what a frame leaves open (the twist of a
// straight arm) stays as it was.
//
// Branching joints turn by Kabsch's fit over their neighbours. Every other joint points at its
// child from where it came to stand itself, so that bone lengths which vary in a capture do not add
// up along a limb; the plane of elbow or knee fixes the twist of the upper limb.
class PoseFitter {
 public:
  // `rig` outlives the fitter.
  explicit PoseFitter(const Rig& rig, BoneLengths lengths = BoneLengths::kRigs);
  // positions: [skeleton joints], metres.
  const RigPose& Fit(absl::Span<const motion::Vec3> positions);

 private:
  Quaternion FitAim(const RigJoint& joint, Vec3d stands_at, Quaternion to_parent,
                    Quaternion previous, absl::Span<const motion::Vec3> positions) const;
  Quaternion FitBend(const RigJoint& joint, Vec3d direction, Vec3d next_bone, Quaternion swing,
                     Quaternion previous) const;

  const Rig& rig_;
  BoneLengths lengths_;
  bool first_ = true;
  RigPose pose_;
};

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_POSE_FITTING_H_
