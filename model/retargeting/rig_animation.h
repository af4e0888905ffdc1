#ifndef DUET_MODEL_RETARGETING_RIG_ANIMATION_H_
#define DUET_MODEL_RETARGETING_RIG_ANIMATION_H_

#include <vector>

#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/foot_pose.h"
#include "model/retargeting/pose_fitting.h"
#include "model/retargeting/rig.h"

namespace duet::retargeting {

// A person for formats with an animated hierarchy: a rig at rest, and rotations and translations of
// its joints. Every joint of the skeleton is exactly at its position in the clip.
struct RigAnimation {
  Rig rig;
  // In the rest pose, which stands on the floor at the origin. [rig joints]
  std::vector<Vec3d> rest_positions;
  double frame_rate_hz = 0;
  double sole_depth = kUsualAnkleHeight;  // below the ankles, metres
  std::vector<RigPose> frames;  // rotations of neighbouring frames are on the same side (q, not -q)

  // A joint's offset from its parent at rest; for the root, its position.
  Vec3d RestTranslation(std::size_t joint) const;
  // Whether a joint keeps its offset from its parent in all frames, up to rounding. Bones of
  // constant length need no translations.
  bool KeepsItsPlace(std::size_t joint) const;
  // Whether a joint never rotates relative to its parent.
  bool NeverTurns(std::size_t joint) const;
};

// A skeleton without toes does not define the rotation of feet: they follow the shin, and are level
// when they stand.
//
// Requires a clip with the skeleton's joints, at least one frame and finite positions. Units:
// metres, y up.
RigAnimation AnimateRig(const motion::Skeleton& skeleton, const motion::Clip& clip);

// The rest positions of a rig's joints, with the lowest at y = 0 and the root above the origin.
// [rig joints]
std::vector<Vec3d> RestPositions(const Rig& rig);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_RIG_ANIMATION_H_
