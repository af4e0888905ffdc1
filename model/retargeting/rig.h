#ifndef DUET_MODEL_RETARGETING_RIG_H_
#define DUET_MODEL_RETARGETING_RIG_H_

#include <string>
#include <vector>

#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// A joint of a rig: a skeleton's joint, or a helper that stands on a joint with several children
// and points at one of them, so that hips, shoulders and neck may move against each other.
struct RigJoint {
  enum class Kind {
    kBranch,  // several children: turns with all its neighbours
    kAim,     // a helper or a limb's joint: points at one child
    kLeaf
  };
  std::string name;  // the skeleton's, or "torso_to_neck" for a helper
  Kind kind = Kind::kLeaf;
  int parent = -1;  // an earlier rig joint
  int joint = 0;    // the skeleton's joint that stands here
  Vec3d offset;     // from the parent in the rest pose, metres

  // kAim: the skeleton's joint pointed at, where that is in the rest pose, and the joint after it,
  // whose plane fixes the twist (-1 when there is none).
  int aim = -1;
  Vec3d rest_direction = {0, 1, 0};
  int bend = -1;

  // kBranch: neighbours on the skeleton and where they are in the rest pose, from here.
  std::vector<int> neighbours;
  std::vector<Vec3d> rest_shape;

  // kLeaf: where the End Site is.
  Vec3d end_offset;
};

// What joint angles turn: the rest pose of a person.
//
// It faces +z with y up. Limbs below the hips hang, limbs that start sideways reach out (a T pose),
// the head stands upright; bones that leave a branching joint keep their mean direction in the
// clip. Every bone has its median length in the clip.
struct Rig {
  std::vector<RigJoint> joints;  // depth first, the skeleton's root first
};

// `clip` has the skeleton's joints, at least one frame and finite positions.
Rig MakeRig(const motion::Skeleton& skeleton, const motion::Clip& clip);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_RIG_H_
