#ifndef DUET_MODEL_RETARGETING_JOINT_TREE_H_
#define DUET_MODEL_RETARGETING_JOINT_TREE_H_

#include <optional>
#include <string>
#include <vector>

#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"
#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// The joints of a file with a hierarchy, independent of any motion.
struct JointTree {
  std::vector<std::string> names;
  std::vector<int> parents;    // [names], an earlier joint; -1 for a root
  std::vector<Vec3d> offsets;  // [names], from the parent and in its axes, in any unit
};

// The nearest common ancestor of `a` and `b`, which may be one of them; -1 if there is none.
int CommonAncestor(const JointTree& tree, int a, int b);
bool IsAtOrBelow(const JointTree& tree, int joint, int ancestor);

// Joints that define a character's proportions, as indices into its tree.
struct Landmarks {
  int head = -1;
  std::optional<motion::JointPair> shoulders, hips;
};

// The joint positions of a straightened character: the trunk upright along y with the summed length
// of its bones, arms stretched to the sides, legs hanging. The positions depend only on bone
// lengths, so that they are equal for every clip of a rig and independent of its rest pose. The
// origin is the joint where legs and trunk meet. [names]
std::vector<motion::Vec3> PullStraight(const JointTree& tree, const Landmarks& landmarks);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_JOINT_TREE_H_
