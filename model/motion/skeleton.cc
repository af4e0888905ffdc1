#include "model/motion/skeleton.h"

#include <algorithm>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/text.h"

namespace duet::motion {
namespace {

absl::Status CheckNames(const Skeleton& skeleton) {
  if (skeleton.joint_names.empty()) {
    return absl::InvalidArgumentError("joint_names: expected at least one joint, got none");
  }
  std::set<std::string> seen;
  for (const std::string& name : skeleton.joint_names) {
    if (name.empty())
      return absl::InvalidArgumentError("joint_names: expected non-empty names, got \"\"");
    if (!seen.insert(name).second) {
      return absl::InvalidArgumentError(
          absl::StrCat("joint_names: ", base::Quoted(name), " is repeated"));
    }
  }
  return absl::OkStatus();
}

absl::Status CheckLandmarks(const Skeleton& skeleton) {
  const std::pair<std::string_view, const std::optional<JointPair>&> sides[] = {
      {"hip", skeleton.hips}, {"foot", skeleton.feet}};
  for (const auto& [name, pair] : sides) {
    if (!pair) continue;
    absl::Status status =
        CheckJoint(absl::StrCat("left_", std::string(name)), pair->left, skeleton);
    if (status.ok()) {
      status = CheckJoint(absl::StrCat("right_", std::string(name)), pair->right, skeleton);
    }
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status CheckTree(const Skeleton& skeleton) {
  const int joints = skeleton.joint_count();
  if (static_cast<int>(skeleton.bones.size()) != joints - 1) {
    return absl::InvalidArgumentError(absl::StrCat("bones: expected ", joints - 1, " to connect ",
                                                   joints, " joints, got ", skeleton.bones.size()));
  }
  std::vector<int> parent(static_cast<size_t>(joints), -1);
  for (const Bone& bone : skeleton.bones) {
    for (int joint : {bone.parent, bone.child}) {
      absl::Status status = CheckJoint("bones", joint, skeleton);
      if (!status.ok()) return status;
    }
    if (bone.child == skeleton.root || parent[static_cast<size_t>(bone.child)] != -1) {
      return absl::InvalidArgumentError(
          absl::StrCat("bones: expected ", bone.child == skeleton.root ? "no parent" : "one parent",
                       " of joint ", bone.child, ", got another"));
    }
    parent[static_cast<size_t>(bone.child)] = bone.parent;
  }
  for (int joint = 0; joint < joints; ++joint) {
    int at = joint;
    for (int steps = 0; at != skeleton.root; ++steps) {
      if (at == -1 || steps > joints) {
        return absl::InvalidArgumentError(
            absl::StrCat("bones: expected joint ", joint, " below the root, got it elsewhere"));
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

absl::Status CheckJoint(std::string_view field, int joint, const Skeleton& skeleton) {
  if (joint >= 0 && joint < skeleton.joint_count()) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(std::string(field),
                                                 ": expected a joint index from 0 to ",
                                                 skeleton.joint_count() - 1, ", got ", joint));
}

std::optional<JointPair> FindHands(const Skeleton& skeleton) {
  for (const char* name : {"wrist", "hand"}) {
    const int left = skeleton.Find(absl::StrCat("left_", name));
    const int right = skeleton.Find(absl::StrCat("right_", name));
    if (left >= 0 && right >= 0) return JointPair{left, right};
  }
  return std::nullopt;
}

absl::Status Validate(const Skeleton& skeleton) {
  absl::Status status = CheckNames(skeleton);
  if (status.ok()) status = CheckJoint("root", skeleton.root, skeleton);
  if (status.ok()) status = CheckLandmarks(skeleton);
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
  skeleton.root = 2;
  skeleton.hips = JointPair{9, 12};
  skeleton.feet = JointPair{11, 14};
  return skeleton;
}

}  // namespace duet::motion
