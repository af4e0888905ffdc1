#ifndef DUET_MODEL_RETARGETING_RIG_H_
#define DUET_MODEL_RETARGETING_RIG_H_

#include <string>
#include <vector>

#include "absl/types/span.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"
#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// A joint of a rig: a skeleton's joint, or a helper at the position of a joint with several
// children. A helper points at one child, so that hips, shoulders and neck can move relative to
// each other.
struct RigJoint {
  enum class Kind {
    kBranch,  // several children: turns with all its neighbours
    kAim,     // a helper or a limb's joint: points at one child
    kLeaf
  };
  std::string name;  // the skeleton's, or "torso_to_neck" for a helper
  Kind kind = Kind::kLeaf;
  int parent = -1;  // an earlier rig joint
  int joint = 0;    // the skeleton's joint at this position
  Vec3d offset;     // from the parent in the rest pose, metres

  // kAim: the skeleton's joint that it points at, that joint's position in the rest pose, and the
  // next joint, whose plane defines the twist (-1 if there is none).
  int aim = -1;
  Vec3d rest_direction = {0, 1, 0};
  int bend = -1;

  // kBranch: neighbours on the skeleton, and their rest positions relative to this joint.
  std::vector<int> neighbours;
  std::vector<Vec3d> rest_shape;

  // kLeaf: the offset of the End Site.
  Vec3d end_offset;
};

// The rest pose of a person, to which joint angles apply.
//
// It faces +z with y up, in a T pose: legs hang, limbs that start sideways are stretched out, the
// head is upright. Bones from a branching joint keep their mean direction in the clip. Every bone
// has its median length in the clip.
struct Rig {
  std::vector<RigJoint> joints;  // depth first, the skeleton's root first
};

// Requires a clip with the skeleton's joints, at least one frame and finite positions.
Rig MakeRig(const motion::Skeleton& skeleton, const motion::Clip& clip);

// Gives the rig's bones the lengths that they have in one pose, in the same directions.
// Shapes: pose [skeleton joints]. Units: metres.
void SetBoneLengths(absl::Span<const motion::Vec3> pose, Rig* rig);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_RIG_H_
