#ifndef DUET_MODEL_MOTION_JOINT_ROTATIONS_H_
#define DUET_MODEL_MOTION_JOINT_ROTATIONS_H_

#include <string>
#include <vector>

#include "model/motion/vec3.h"

namespace duet::motion {

// A joint of a hierarchy in its rest pose, in which every local rotation is the identity.
struct RestJoint {
  std::string name;
  int parent = -1;  // an earlier joint; -1 for the root, which is the first
  Vec3 offset;      // from the parent at rest; zero for the root
  int joint = 0;    // of the clip, at the same position
};

// A rotation, as a unit quaternion.
struct UnitQuaternion {
  float x = 0, y = 0, z = 0, w = 1;
};

// A motion as rotations of a hierarchy, beside its positions. docs/rotations.md has the convention.
struct JointRotations {
  std::vector<RestJoint> rig;
  // Relative to the parent; the root's is its rotation in the world.
  // Shapes: [frames, rig], row-major.
  std::vector<UnitQuaternion> rotations;
};

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_JOINT_ROTATIONS_H_
