#include "client/capture/humanoid.h"

#include <map>
#include <string>
#include <utility>

#include "absl/strings/match.h"
#include "model/retargeting/joint_names.h"

namespace duet::client::capture {
namespace {

using retargeting::BodySide;
using BoneName = std::pair<BodySide, std::string>;

// The bones of the names that files have for joints. Unity's own names come first: LeftShoulder is
// the collar bone.
std::map<BoneName, int> MakeAliases() {
  const auto& bones = HumanoidBones();
  std::map<BoneName, int> aliases;
  std::map<std::string, std::string> joints = {
      {"hips", "hips"},      {"neck", "neck"}, {"head", "head"},     {"upperarm", "shoulder"},
      {"lowerarm", "elbow"}, {"hand", "hand"}, {"lowerleg", "knee"}, {"upperleg", "hip"},
      {"foot", "foot"},      {"toes", "toe"}};
  const auto parse = [&bones](std::size_t bone) {
    return retargeting::ParseJointName(bones[bone].name);
  };
  for (std::size_t bone = 0; bone < bones.size(); ++bone) {
    aliases.emplace(BoneName{parse(bone).side, parse(bone).base}, static_cast<int>(bone));
  }
  // Knees first: LeftLeg is the lower leg wherever there is a LeftUpLeg.
  for (const char* base : {"lowerleg", "upperleg", "upperarm", "lowerarm", "hand", "foot", "toes",
                           "hips", "neck", "head"}) {
    for (std::size_t bone = 0; bone < bones.size(); ++bone) {
      if (parse(bone).base != base) continue;
      for (const std::string& alias : retargeting::JointAliases(joints[base])) {
        aliases.emplace(BoneName{parse(bone).side, alias}, static_cast<int>(bone));
      }
    }
  }
  return aliases;
}

}  // namespace

using retargeting::Vec3d;

const std::array<HumanoidBone, kHumanoidBoneCount>& HumanoidBones() {
  static constexpr int kNone = -1, kHips = 0, kUpperChest = 3;
  static const auto* const kBones = new std::array<HumanoidBone, kHumanoidBoneCount>{{
      {"Hips", kNone, {0, 0.95, 0}},
      {"Spine", kHips, {0, 0.10, 0}},
      {"Chest", 1, {0, 0.13, 0}},
      {"UpperChest", 2, {0, 0.12, 0}},
      {"Neck", kUpperChest, {0, 0.15, 0}},
      {"Head", 4, {0, 0.09, 0}},
      {"LeftShoulder", kUpperChest, {0.04, 0.11, 0}},
      {"LeftUpperArm", 6, {0.13, 0, 0}},
      {"LeftLowerArm", 7, {0.28, 0, 0}},
      {"LeftHand", 8, {0.25, 0, 0}},
      {"RightShoulder", kUpperChest, {-0.04, 0.11, 0}},
      {"RightUpperArm", 10, {-0.13, 0, 0}},
      {"RightLowerArm", 11, {-0.28, 0, 0}},
      {"RightHand", 12, {-0.25, 0, 0}},
      {"LeftUpperLeg", kHips, {0.09, -0.05, 0}},
      {"LeftLowerLeg", 14, {0, -0.42, 0}},
      {"LeftFoot", 15, {0, -0.41, 0}},
      {"LeftToes", 16, {0, -0.05, 0.13}},
      {"RightUpperLeg", kHips, {-0.09, -0.05, 0}},
      {"RightLowerLeg", 18, {0, -0.42, 0}},
      {"RightFoot", 19, {0, -0.41, 0}},
      {"RightToes", 20, {0, -0.05, 0.13}},
  }};
  return *kBones;
}

int FindHumanoidBone(absl::string_view name) {
  const auto& bones = HumanoidBones();
  for (std::size_t bone = 0; bone < bones.size(); ++bone) {
    if (absl::EqualsIgnoreCase(name, bones[bone].name)) return static_cast<int>(bone);
  }
  static const auto* const kAliases = new std::map<BoneName, int>(MakeAliases());
  const retargeting::ParsedJointName parsed = retargeting::ParseJointName(name);
  const auto found = kAliases->find({parsed.side, parsed.base});
  return found == kAliases->end() ? -1 : found->second;
}

std::vector<Vec3d> HumanoidRestPositions() {
  std::vector<Vec3d> positions;
  for (const HumanoidBone& bone : HumanoidBones()) {
    const Vec3d parent =
        bone.parent < 0 ? Vec3d{} : positions[static_cast<std::size_t>(bone.parent)];
    positions.push_back(parent + bone.offset);
  }
  return positions;
}

}  // namespace duet::client::capture
