#ifndef DUET_CLIENT_CAPTURE_HUMANOID_H_
#define DUET_CLIENT_CAPTURE_HUMANOID_H_

#include <array>
#include <cstddef>
#include <vector>

#include "absl/strings/string_view.h"
#include "model/retargeting/rotation.h"

// Unity's humanoid bones, as VMC names them, and the built-in person who stands in for what a
// sender leaves out.

namespace duet::client::capture {

struct HumanoidBone {
  const char* name;           // Unity's HumanBodyBones
  int parent;                 // an earlier bone; -1 for Hips, whose parent is the avatar's root
  retargeting::Vec3d offset;  // from the parent in a T pose that faces +z; metres, right-handed
};

// The bones of the body, without fingers, eyes and jaw.
inline constexpr std::size_t kHumanoidBoneCount = 22;
const std::array<HumanoidBone, kHumanoidBoneCount>& HumanoidBones();

// The index of a bone, or -1. The name is Unity's, VRM 1.0's (leftUpperArm), or one that files have
// for the joint (retargeting::JointAliases), such as LeftArm for LeftUpperArm.
int FindHumanoidBone(absl::string_view name);

// The positions of the bones of the built-in person, who stands on the floor at the origin.
// [bones], metres, right-handed.
std::vector<retargeting::Vec3d> HumanoidRestPositions();

}  // namespace duet::client::capture

#endif  // DUET_CLIENT_CAPTURE_HUMANOID_H_
