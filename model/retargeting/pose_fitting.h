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
  explicit PoseFitter(const Rig& rig);
  // positions: [skeleton joints], metres.
  const RigPose& Fit(absl::Span<const motion::Vec3> positions);

 private:
  Quaternion FitAim(const RigJoint& joint, Vec3d stands_at, Quaternion to_parent,
                    Quaternion previous, absl::Span<const motion::Vec3> positions) const;
  Quaternion FitBend(const RigJoint& joint, Vec3d direction, Vec3d next_bone, Quaternion swing,
                     Quaternion previous) const;

  const Rig& rig_;
  bool first_ = true;
  RigPose pose_;
};

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_POSE_FITTING_H_
