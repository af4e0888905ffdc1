#ifndef DUET_MODEL_RETARGETING_JOINT_TREE_H_
#define DUET_MODEL_RETARGETING_JOINT_TREE_H_

#include <optional>
#include <string>
#include <vector>

#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"
#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// The joints of a file with a hierarchy: a character as it is made, whatever it does in a clip.
struct JointTree {
  std::vector<std::string> names;
  std::vector<int> parents;    // [names], an earlier joint; -1 for a root
  std::vector<Vec3d> offsets;  // [names], from the parent and in its axes, in any unit
};

// The nearest joint that `a` and `b` both are or hang from; -1 where they share none.
int CommonAncestor(const JointTree& tree, int a, int b);
bool IsAtOrBelow(const JointTree& tree, int joint, int ancestor);

// Joints that tell how a character is built, as indices into its tree.
struct Landmarks {
  int head = -1;
  std::optional<motion::JointPair> shoulders, hips;
};

// Where the joints are of a character pulled straight: the trunk upright along y, as long as its
// bones are together, arms stretched to the sides, legs hanging. It has its measures from the
// bones' lengths alone, so that they are the same in every clip of a rig, and whichever way its
// bones point at rest. The origin is where legs and trunk part. [names]
std::vector<motion::Vec3> PullStraight(const JointTree& tree, const Landmarks& landmarks);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_JOINT_TREE_H_
