#ifndef DUET_MODEL_RETARGETING_CHARACTER_RIG_H_
#define DUET_MODEL_RETARGETING_CHARACTER_RIG_H_

#include <string>
#include <vector>

#include "model/motion/skeleton.h"
#include "model/retargeting/joint_mapping.h"
#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// The user's rig in its rest pose, as read from a file: the target of a motion transfer.
//
// Units: metres, y up, in the world.
struct CharacterRig {
  std::vector<std::string> names;
  std::vector<int> parents;      // [names], an earlier joint; -1 for the root
  std::vector<Vec3d> positions;  // [names]
  // Joints that a file of the rig may translate in every frame, at least the root.
  std::vector<bool> moves;  // [names]
  // Maps the rig's joints to the skeleton's.
  JointMap joints;
};

// One frame on a rig: the rotation of every joint from the rest pose, in world axes (an undriven
// joint has its parent's rotation), and its position.
struct CharacterPose {
  std::vector<Quaternion> turns;  // [names]
  std::vector<Vec3d> positions;   // [names]
};

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_CHARACTER_RIG_H_
