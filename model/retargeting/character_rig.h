#ifndef DUET_MODEL_RETARGETING_CHARACTER_RIG_H_
#define DUET_MODEL_RETARGETING_CHARACTER_RIG_H_

#include <string>
#include <vector>

#include "model/motion/skeleton.h"
#include "model/retargeting/joint_mapping.h"
#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// Somebody else's rig at rest, as a file has it: what a motion is to be written onto.
//
// Units: metres, y up, in the world.
struct CharacterRig {
  std::vector<std::string> names;
  std::vector<int> parents;      // [names], an earlier joint; -1 for the root
  std::vector<Vec3d> positions;  // [names]
  // Joints whose place a file of the rig may say in every frame: the root's, if nothing else.
  std::vector<bool> moves;  // [names]
  // How the skeleton's joints are found on it.
  JointMap joints;
};

// One frame on a rig: how far every joint is turned from rest, in the world and the world's axes
// (an undriven joint is turned as its parent), and where it stands.
struct CharacterPose {
  std::vector<Quaternion> turns;  // [names]
  std::vector<Vec3d> positions;   // [names]
};

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_CHARACTER_RIG_H_
