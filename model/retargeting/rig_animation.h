#ifndef DUET_MODEL_RETARGETING_RIG_ANIMATION_H_
#define DUET_MODEL_RETARGETING_RIG_ANIMATION_H_

#include <vector>

#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/foot_pose.h"
#include "model/retargeting/pose_fitting.h"
#include "model/retargeting/rig.h"

namespace duet::retargeting {

// A person as formats with an animated hierarchy have it: a rig at rest, and how its joints turn
// and move. Every joint of the skeleton stands exactly where the clip has it.
struct RigAnimation {
  Rig rig;
  // In the rest pose, which stands on the floor at the origin. [rig joints]
  std::vector<Vec3d> rest_positions;
  double frame_rate_hz = 0;
  double sole_depth = kUsualAnkleHeight;  // below the ankles, metres
  std::vector<RigPose> frames;  // rotations of neighbouring frames are on the same side (q, not -q)

  // Where a joint is from its parent at rest; the root's is its position.
  Vec3d RestTranslation(std::size_t joint) const;
  // Whether a joint keeps its place in its parent's axes in all frames, but for rounding: bones of
  // constant length need no translations.
  bool KeepsItsPlace(std::size_t joint) const;
  // Whether a joint never turns in its parent's axes.
  bool NeverTurns(std::size_t joint) const;
};

// Feet, which a skeleton without toes leaves open, follow the shin, and are level where they stand.
//
// Requires a clip of the skeleton's joints with one frame at least and finite positions. Units:
// metres, y up.
RigAnimation AnimateRig(const motion::Skeleton& skeleton, const motion::Clip& clip);

// Where every joint of a rig stands at rest, the lowest at y = 0 and the root above the origin.
// [rig joints]
std::vector<Vec3d> RestPositions(const Rig& rig);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_RIG_ANIMATION_H_
