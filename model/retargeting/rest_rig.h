#ifndef DUET_MODEL_RETARGETING_REST_RIG_H_
#define DUET_MODEL_RETARGETING_REST_RIG_H_

#include <vector>

#include "model/motion/coordinates.h"
#include "model/retargeting/character.h"
#include "model/retargeting/character_rig.h"
#include "model/retargeting/joint_tree.h"
#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// The rotation from a file's axes to the world's.
Quaternion ToWorldAxes(motion::UpAxis up_axis);

// The rig of a file whose joints have no rotation at rest (BVH, ASF): the tree's offsets define the
// rest positions, with roots at the origin. Only roots are translated.
//
// `fit` is the result of ToClip for the same tree.
CharacterRig RestRig(const JointTree& tree, const CharacterFit& fit);

// The same rig with another pose as its rest pose. `positions` are those of the tree's joints in
// the file's unit and axes.
CharacterRig RestRig(const JointTree& tree, const CharacterFit& fit,
                     const std::vector<Vec3d>& positions);

// Reports that a frame of a rig's motion replaces its rest pose (FindRestFrame).
void NoteRestFrame(int frame, const CharacterOptions& options);

// One frame of such a rig, relative to parents. [rig joints]
struct LocalPose {
  std::vector<Quaternion> turns;  // in the parent's axes
  std::vector<Vec3d> places;      // from the parent in its axes, metres; for a root, in the world
};
LocalPose ToLocal(const CharacterRig& rig, const CharacterPose& pose);

// The rig's joints in depth-first order, which is the order of BVH; roots keep their order.
std::vector<int> DepthFirst(const std::vector<int>& parents);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_REST_RIG_H_
