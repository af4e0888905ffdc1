#ifndef DUET_MODEL_RETARGETING_REST_RIG_H_
#define DUET_MODEL_RETARGETING_REST_RIG_H_

#include <vector>

#include "model/motion/coordinates.h"
#include "model/retargeting/character.h"
#include "model/retargeting/character_rig.h"
#include "model/retargeting/joint_tree.h"
#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// The turn from a file's axes to the world's.
Quaternion ToWorldAxes(motion::UpAxis up_axis);

// The rig of a file whose joints are not turned at rest (BVH, ASF): joints stand where the tree's
// offsets put them, the roots at the origin. Only roots move.
//
// `fit` is how ToClip understood the same tree.
CharacterRig RestRig(const JointTree& tree, const CharacterFit& fit);

// One frame of such a rig from joint to joint. [rig joints]
struct LocalPose {
  std::vector<Quaternion> turns;  // in the parent's axes
  std::vector<Vec3d> places;      // from the parent and in its axes, metres; a root's in the world
};
LocalPose ToLocal(const CharacterRig& rig, const CharacterPose& pose);

// The rig's joints with every parent directly before its first child, roots in their order: the
// order in which BVH lists joints.
std::vector<int> DepthFirst(const std::vector<int>& parents);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_REST_RIG_H_
