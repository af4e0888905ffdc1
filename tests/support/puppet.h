#ifndef DUET_TESTS_SUPPORT_PUPPET_H_
#define DUET_TESTS_SUPPORT_PUPPET_H_

#include <vector>

#include "model/motion/vec3.h"
#include "model/retargeting/rotation.h"

namespace duet::test {

// Degrees: yaw to the left, pitch forwards, roll to the left.
struct Lean {
  double yaw = 0, pitch = 0, roll = 0;
};

// One pose of a puppet, as set by hand. Axes: x to its left, y up, z forwards; metres, with the
// floor at y = 0.
struct PuppetPose {
  retargeting::Vec3d torso;
  Lean pelvis, chest, head;  // each from upright, facing +z
  struct Limb {
    retargeting::Vec3d target;  // feet: the ankle; hands: the wrist, from the neck
    double swivel = 0;          // outward rotation of elbow or knee from its natural place, degrees
  };
  Limb left_foot, right_foot, left_hand, right_hand;
};

// The joints of SbuSkeleton for a pose. Bones have the constant lengths of an adult. A limb
// stretches towards a target out of reach. Knees bend forwards, elbows backwards and down. [15]
std::vector<motion::Vec3> PosePuppet(const PuppetPose& pose);

}  // namespace duet::test

#endif  // DUET_TESTS_SUPPORT_PUPPET_H_
