#include "model/retargeting/anatomy.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/retargeting/joint_mapping.h"
#include "model/retargeting/joint_names.h"

namespace duet::retargeting {
namespace {

constexpr std::size_t kMostNamesInError = 60;

struct Landmark {
  const char* name;      // in the words of JointAliases
  const char* examples;  // for messages
};
constexpr Landmark kHip = {"hip", "left_hip, LeftUpLeg or L Thigh"};
constexpr Landmark kFoot = {"foot", "left_foot, LeftAnkle or L Foot"};
constexpr Landmark kShoulder = {"shoulder", "left_shoulder, LeftArm or L UpperArm"};
constexpr Landmark kHand = {"hand", "left_hand, LeftWrist or L Hand"};

class Finder {
 public:
  explicit Finder(const motion::Skeleton& skeleton)
      : skeleton_(skeleton), parents_(skeleton.Parents()) {
    for (const std::string& name : skeleton.joint_names) parsed_.push_back(ParseJointName(name));
  }

  // Finds both sides by the same alias, so that a pair is never a thigh and a leg.
  std::optional<motion::JointPair> FindByName(const Landmark& landmark) const {
    for (const std::string& alias : JointAliases(landmark.name)) {
      const int left = Find({BodySide::kLeft, alias}), right = Find({BodySide::kRight, alias});
      if (left >= 0 && right >= 0) return motion::JointPair{left, right};
    }
    return std::nullopt;
  }

  absl::StatusOr<motion::JointPair> Require(const Landmark& landmark) const {
    if (const std::optional<motion::JointPair> pair = FindByName(landmark)) return *pair;
    return absl::InvalidArgumentError(absl::StrCat("no joint's name says left and right ",
                                                   landmark.name, " (such as ", landmark.examples,
                                                   "); the skeleton has ", SomeNames()));
  }

  std::vector<int> Below(int top) const {
    std::vector<int> joints;
    for (int joint = 0; joint < skeleton_.joint_count(); ++joint) {
      if (IsAtOrBelow(parents_, joint, top)) joints.push_back(joint);
    }
    return joints;
  }

  // The joint that is farthest from `top` along the bones.
  int Outermost(int top) const {
    int outermost = top, most = 0;
    for (const int joint : Below(top)) {
      int steps = 0;
      for (int at = joint; at != top; at = parents_[static_cast<std::size_t>(at)]) ++steps;
      if (steps > most) outermost = joint;
      most = std::max(most, steps);
    }
    return outermost;
  }

  const std::string& NameOf(int joint) const {
    return skeleton_.joint_names[static_cast<std::size_t>(joint)];
  }

 private:
  int Find(const ParsedJointName& name) const {
    for (std::size_t i = 0; i < parsed_.size(); ++i) {
      if (parsed_[i] == name) return static_cast<int>(i);
    }
    return -1;
  }

  std::string SomeNames() const {
    std::vector<std::string> names = skeleton_.joint_names;
    const bool all = names.size() <= kMostNamesInError;
    if (!all) names.resize(kMostNamesInError);
    return absl::StrCat(absl::StrJoin(names, ", "), all ? "" : ", ...");
  }

  const motion::Skeleton& skeleton_;
  const std::vector<int> parents_;
  std::vector<ParsedJointName> parsed_;
};

// Assigns every joint to one part. Omits empty parts.
std::vector<motion::BodyPart> FindParts(const Finder& finder, const Anatomy& anatomy,
                                        int joint_count) {
  std::vector<motion::BodyPart> parts = {{"left_arm", finder.Below(anatomy.shoulders.left)},
                                         {"right_arm", finder.Below(anatomy.shoulders.right)},
                                         {"left_leg", finder.Below(anatomy.hips.left)},
                                         {"right_leg", finder.Below(anatomy.hips.right)}};
  std::vector<bool> in_limb(static_cast<std::size_t>(joint_count));
  for (const motion::BodyPart& part : parts) {
    for (const int joint : part.joints) in_limb[static_cast<std::size_t>(joint)] = true;
  }
  motion::BodyPart trunk = {"trunk", {}};
  for (int joint = 0; joint < joint_count; ++joint) {
    if (!in_limb[static_cast<std::size_t>(joint)]) trunk.joints.push_back(joint);
  }
  if (!trunk.joints.empty()) parts.push_back(std::move(trunk));
  return parts;
}

std::string PairNote(const Finder& finder, const char* name, motion::JointPair pair) {
  return absl::StrCat("left_", name, ", right_", name, ": ", finder.NameOf(pair.left), ", ",
                      finder.NameOf(pair.right));
}

std::string PartsNote(const Finder& finder, const std::vector<motion::BodyPart>& parts) {
  return absl::StrCat(
      "parts: ", absl::StrJoin(parts, "; ", [&](std::string* out, const motion::BodyPart& part) {
        absl::StrAppend(out, part.name, " ",
                        absl::StrJoin(part.joints, ", ", [&](std::string* names, int joint) {
                          names->append(finder.NameOf(joint));
                        }));
      }));
}

}  // namespace

absl::StatusOr<Anatomy> FindAnatomy(const motion::Skeleton& skeleton) {
  const Finder finder(skeleton);
  Anatomy anatomy;
  const auto find = [&](const Landmark& landmark, const std::optional<motion::JointPair>& known,
                        motion::JointPair* found) {
    if (known) {
      *found = *known;
      return absl::OkStatus();
    }
    const absl::StatusOr<motion::JointPair> pair = finder.Require(landmark);
    if (!pair.ok()) return pair.status();
    *found = *pair;
    anatomy.notes.push_back(PairNote(finder, landmark.name, *pair));
    return absl::OkStatus();
  };
  absl::Status status = find(kHip, skeleton.hips, &anatomy.hips);
  if (status.ok()) status = find(kFoot, skeleton.feet, &anatomy.feet);
  if (status.ok()) status = find(kShoulder, std::nullopt, &anatomy.shoulders);
  if (!status.ok()) return status;
  anatomy.hands = finder.FindByName(kHand).value_or(motion::JointPair{
      finder.Outermost(anatomy.shoulders.left), finder.Outermost(anatomy.shoulders.right)});
  anatomy.parts = FindParts(finder, anatomy, skeleton.joint_count());
  anatomy.notes.push_back(PartsNote(finder, anatomy.parts));
  return anatomy;
}

std::vector<int> CounterpartJoints(const std::vector<std::string>& joint_names) {
  std::vector<ParsedJointName> parsed;
  for (const std::string& name : joint_names) parsed.push_back(ParseJointName(name));
  std::vector<int> counterparts;
  for (std::size_t joint = 0; joint < parsed.size(); ++joint) {
    ParsedJointName other = parsed[joint];
    if (other.side != BodySide::kMiddle) {
      other.side = other.side == BodySide::kLeft ? BodySide::kRight : BodySide::kLeft;
    }
    const auto found = std::find(parsed.begin(), parsed.end(), other);
    counterparts.push_back(other == parsed[joint] || found == parsed.end()
                               ? static_cast<int>(joint)
                               : static_cast<int>(found - parsed.begin()));
  }
  return counterparts;
}

}  // namespace duet::retargeting
