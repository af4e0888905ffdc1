#include "model/motion/skeleton.h"

#include <algorithm>
#include <set>

#include "absl/strings/str_cat.h"

namespace duet::motion {
namespace {

absl::Status CheckIndex(std::string_view field, int index, int count) {
  if (index >= 0 && index < count) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat(std::string(field), ": joint index ", index, ", wanted 0 to ", count - 1));
}

absl::Status CheckNames(const Skeleton& skeleton) {
  if (skeleton.joint_names.empty()) {
    return absl::InvalidArgumentError("joint_names: empty, wanted at least one joint");
  }
  std::set<std::string> seen;
  for (const std::string& name : skeleton.joint_names) {
    if (name.empty()) return absl::InvalidArgumentError("joint_names: an empty name");
    if (!seen.insert(name).second) {
      return absl::InvalidArgumentError(absl::StrCat("joint_names: \"", name, "\" is repeated"));
    }
  }
  return absl::OkStatus();
}

absl::Status CheckParts(const Skeleton& skeleton) {
  if (skeleton.parts.empty()) {
    return absl::InvalidArgumentError("parts: empty, wanted at least one");
  }
  for (const BodyPart& part : skeleton.parts) {
    if (part.joints.empty()) {
      return absl::InvalidArgumentError(absl::StrCat("parts: \"", part.name, "\" has no joints"));
    }
    for (int joint : part.joints) {
      absl::Status status =
          CheckIndex(absl::StrCat("parts.", part.name), joint, skeleton.joint_count());
      if (!status.ok()) return status;
    }
  }
  return absl::OkStatus();
}

absl::Status CheckTree(const Skeleton& skeleton) {
  const int joints = skeleton.joint_count();
  if (static_cast<int>(skeleton.bones.size()) != joints - 1) {
    return absl::InvalidArgumentError(absl::StrCat("bones: ", skeleton.bones.size(), ", wanted ",
                                                   joints - 1, " to connect ", joints, " joints"));
  }
  std::vector<int> parent(static_cast<size_t>(joints), -1);
  for (const Bone& bone : skeleton.bones) {
    for (int joint : {bone.parent, bone.child}) {
      absl::Status status = CheckIndex("bones", joint, joints);
      if (!status.ok()) return status;
    }
    if (bone.child == skeleton.root || parent[static_cast<size_t>(bone.child)] != -1) {
      return absl::InvalidArgumentError(
          absl::StrCat("bones: joint ", bone.child, " may not have a further parent"));
    }
    parent[static_cast<size_t>(bone.child)] = bone.parent;
  }
  for (int joint = 0; joint < joints; ++joint) {
    int at = joint;
    for (int steps = 0; at != skeleton.root; ++steps) {
      if (at == -1 || steps > joints) {
        return absl::InvalidArgumentError(
            absl::StrCat("bones: joint ", joint, " is not connected to the root"));
      }
      at = parent[static_cast<size_t>(at)];
    }
  }
  return absl::OkStatus();
}

}  // namespace

int Skeleton::Find(std::string_view joint_name) const {
  const auto it = std::find(joint_names.begin(), joint_names.end(), joint_name);
  return it == joint_names.end() ? -1 : static_cast<int>(it - joint_names.begin());
}

std::vector<int> Skeleton::Parents() const {
  std::vector<int> parents(joint_names.size(), -1);
  for (const Bone& bone : bones) parents[static_cast<size_t>(bone.child)] = bone.parent;
  return parents;
}

absl::Status Validate(const Skeleton& skeleton) {
  absl::Status status = CheckNames(skeleton);
  const std::pair<std::string_view, int> landmarks[] = {{"root", skeleton.root},
                                                        {"left_hip", skeleton.left_hip},
                                                        {"right_hip", skeleton.right_hip},
                                                        {"left_foot", skeleton.left_foot},
                                                        {"right_foot", skeleton.right_foot}};
  for (const auto& [field, index] : landmarks) {
    if (status.ok()) status = CheckIndex(field, index, skeleton.joint_count());
  }
  if (status.ok()) status = CheckParts(skeleton);
  if (status.ok()) status = CheckTree(skeleton);
  return status;
}

std::vector<int> BonesFromRoot(const Skeleton& skeleton) {
  std::vector<int> order;
  std::vector<int> reached = {skeleton.root};
  for (size_t next = 0; next < reached.size(); ++next) {
    for (size_t b = 0; b < skeleton.bones.size(); ++b) {
      if (skeleton.bones[b].parent != reached[next]) continue;
      order.push_back(static_cast<int>(b));
      reached.push_back(skeleton.bones[b].child);
    }
  }
  return order;
}

Skeleton SbuSkeleton() {
  Skeleton skeleton;
  skeleton.joint_names = {"head",       "neck",       "torso",          "left_shoulder",
                          "left_elbow", "left_hand",  "right_shoulder", "right_elbow",
                          "right_hand", "left_hip",   "left_knee",      "left_foot",
                          "right_hip",  "right_knee", "right_foot"};
  skeleton.bones = {{1, 0}, {2, 1}, {1, 3}, {1, 6},  {2, 9},   {2, 12},  {3, 4},
                    {4, 5}, {6, 7}, {7, 8}, {9, 10}, {10, 11}, {12, 13}, {13, 14}};
  skeleton.parts = {{"left_arm", {3, 4, 5}},
                    {"right_arm", {6, 7, 8}},
                    {"left_leg", {9, 10, 11}},
                    {"right_leg", {12, 13, 14}},
                    {"trunk", {0, 1, 2}}};
  skeleton.root = 2;
  skeleton.left_hip = 9;
  skeleton.right_hip = 12;
  skeleton.left_foot = 11;
  skeleton.right_foot = 14;
  return skeleton;
}

}  // namespace duet::motion
