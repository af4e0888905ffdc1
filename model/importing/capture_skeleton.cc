#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/file.h"
#include "model/base/status_macros.h"
#include "model/base/strict_json.h"
#include "model/formats/bvh/bvh_document.h"
#include "model/formats/motion_file.h"
#include "model/importing/steps.h"
#include "model/motion/motion_limits.h"
#include "model/retargeting/anatomy.h"
#include "model/retargeting/joint_names.h"

namespace duet::importing {
namespace {

namespace fs = std::filesystem;
using retargeting::BodySide;
using retargeting::ParsedJointName;

constexpr std::size_t kMaxSkeletonBytes = std::size_t{1} << 20;
constexpr int kMaxSkeletonDepth = 5;

motion::Skeleton ParentsToSkeleton(std::vector<std::string> names,
                                   const std::vector<int>& parents) {
  motion::Skeleton skeleton;
  skeleton.joint_names = std::move(names);
  for (std::size_t joint = 0; joint < parents.size(); ++joint) {
    if (parents[joint] < 0) {
      skeleton.root = static_cast<int>(joint);
    } else {
      skeleton.bones.push_back({parents[joint], static_cast<int>(joint)});
    }
  }
  return skeleton;
}

// Keeps only the joints of `kept`. The parent of each is its nearest kept ancestor.
motion::Skeleton Keep(const motion::Skeleton& all, const std::vector<bool>& kept) {
  const std::vector<int> parents = all.Parents();
  std::vector<int> index(kept.size(), -1);
  std::vector<std::string> names;
  for (std::size_t joint = 0; joint < kept.size(); ++joint) {
    if (!kept[joint]) continue;
    index[joint] = static_cast<int>(names.size());
    names.push_back(all.joint_names[joint]);
  }
  std::vector<int> kept_parents;
  for (std::size_t joint = 0; joint < kept.size(); ++joint) {
    if (!kept[joint]) continue;
    int parent = parents[joint];
    while (parent >= 0 && !kept[static_cast<std::size_t>(parent)]) {
      parent = parents[static_cast<std::size_t>(parent)];
    }
    kept_parents.push_back(parent < 0 ? -1 : index[static_cast<std::size_t>(parent)]);
  }
  return ParentsToSkeleton(std::move(names), kept_parents);
}

// Whether the joint is always at its parent. Exporters write such joints to rotate each child
// separately.
bool IsHelper(const formats::bvh::BvhJoint& joint) {
  using formats::bvh::BvhChannel;
  const bool moves = std::any_of(joint.channels.begin(), joint.channels.end(), [](BvhChannel c) {
    return c == BvhChannel::kXPosition || c == BvhChannel::kYPosition ||
           c == BvhChannel::kZPosition;
  });
  return joint.parent >= 0 && !moves && Norm(joint.offset) == 0;
}

// Returns the skeleton of the first person.
absl::StatusOr<motion::Skeleton> BvhSkeleton(const std::string& text, const std::string& source) {
  DUET_TRY(const formats::bvh::BvhDocument document, formats::bvh::ParseBvh(text, source));
  std::vector<std::string> names;
  std::vector<int> parents;
  std::vector<bool> kept;
  for (const formats::bvh::BvhJoint& joint : document.joints) {
    if (joint.parent < 0 && !names.empty()) break;  // the second person
    names.push_back(joint.name);
    parents.push_back(joint.parent);
    kept.push_back(!joint.end_site && !IsHelper(joint));
  }
  return Keep(ParentsToSkeleton(std::move(names), parents), kept);
}

// A file of positions has no hierarchy, but may have the names of SBU's joints.
absl::StatusOr<motion::Skeleton> ReadCaptured(const fs::path& file) {
  const std::optional<formats::Format> format = formats::FormatOf(file);
  if (format == formats::Format::kGltf || format == formats::Format::kGlb) {
    return absl::InvalidArgumentError(
        absl::StrCat(file.string(), ": skeleton: expected --skeleton for glTF, got none"));
  }
  if (format != formats::Format::kBvh) return motion::SbuSkeleton();
  DUET_TRY(const std::string text, base::ReadFile(file, motion::kMaxMotionFileBytes, "a motion"));
  return BvhSkeleton(text, file.string());
}

// Omits fingers and face: they move little, but losses weight every joint equally.
motion::Skeleton WithoutFingersAndFace(const motion::Skeleton& skeleton, motion::JointPair hands) {
  const std::vector<int> parents = skeleton.Parents();
  std::vector<bool> kept(skeleton.joint_names.size(), true);
  for (std::size_t joint = 0; joint < kept.size(); ++joint) {
    for (int at = parents[joint]; at >= 0; at = parents[static_cast<std::size_t>(at)]) {
      const bool is_head =
          retargeting::ParseJointName(skeleton.joint_names[static_cast<std::size_t>(at)]) ==
          ParsedJointName{BodySide::kMiddle, "head"};
      if (at == hands.left || at == hands.right || is_head) kept[joint] = false;
    }
  }
  return Keep(skeleton, kept);
}

bool AreUnique(const std::vector<std::string>& names) {
  return std::set<std::string>(names.begin(), names.end()).size() == names.size();
}

// "mixamorig:LeftToeBase" -> "left_toebase".
std::string PlainName(const std::string& name) {
  const ParsedJointName parsed = retargeting::ParseJointName(name);
  const char* const side = parsed.side == BodySide::kLeft    ? "left_"
                           : parsed.side == BodySide::kRight ? "right_"
                                                             : "";
  return absl::StrCat(side, parsed.base);
}

// Assigns Duet's names if they are unique, or else plain names, or else keeps the file's.
void Rename(const retargeting::Anatomy& anatomy, motion::Skeleton* skeleton) {
  std::vector<std::string> plain;
  for (const std::string& name : skeleton->joint_names) plain.push_back(PlainName(name));
  std::vector<std::string> known = plain;
  const auto name_pair = [&](motion::JointPair pair, const std::string& word) {
    known[static_cast<std::size_t>(pair.left)] = "left_" + word;
    known[static_cast<std::size_t>(pair.right)] = "right_" + word;
  };
  name_pair(anatomy.hips, "hip");
  name_pair(anatomy.feet, "foot");
  name_pair(anatomy.hands, "hand");
  if (AreUnique(known)) {
    skeleton->joint_names = known;
  } else if (AreUnique(plain)) {
    skeleton->joint_names = plain;
  }
}

absl::StatusOr<CaptureSkeleton> Complete(motion::Skeleton skeleton, const std::string& source) {
  const auto in_file = [&](const absl::Status& status) {
    return absl::InvalidArgumentError(
        absl::StrCat(source, ": ", status.message(), "; specify --skeleton"));
  };
  if (const absl::Status valid = Validate(skeleton); !valid.ok()) return in_file(valid);
  absl::StatusOr<retargeting::Anatomy> anatomy = retargeting::FindAnatomy(skeleton);
  if (!anatomy.ok()) return in_file(anatomy.status());
  const int before = skeleton.joint_count();
  skeleton = WithoutFingersAndFace(skeleton, anatomy->hands);
  skeleton.hips = skeleton.feet = std::nullopt;
  anatomy = retargeting::FindAnatomy(skeleton);
  if (!anatomy.ok()) return in_file(anatomy.status());
  CaptureSkeleton found;
  found.notes = anatomy->notes;
  if (skeleton.joint_count() < before) {
    found.notes.push_back(
        absl::StrCat("left out: ", before - skeleton.joint_count(), " joints of fingers and face"));
  }
  Rename(*anatomy, &skeleton);
  skeleton.hips = anatomy->hips;
  skeleton.feet = anatomy->feet;
  found.skeleton = std::move(skeleton);
  found.parts = std::move(anatomy->parts);
  found.hands = anatomy->hands;
  found.origin = source;
  return found;
}

// Reads the skeleton that --skeleton specifies.
absl::StatusOr<CaptureSkeleton> ReadSpecified(const std::string& specified) {
  motion::SkeletonDocument document = {motion::SbuSkeleton(), motion::SbuParts()};
  CaptureSkeleton found;
  found.origin = "the 15 joints of Duet's own models";
  if (specified != "sbu") {
    DUET_TRY(const std::string text, base::ReadFile(specified, kMaxSkeletonBytes, "a skeleton"));
    absl::StatusOr<nlohmann::json> json = base::ParseHandwrittenJson(text, kMaxSkeletonDepth);
    absl::StatusOr<motion::SkeletonDocument> read =
        json.ok() ? dataset::ReadWrittenSkeleton(*std::move(json), &found.notes) : json.status();
    if (!read.ok()) {
      return absl::InvalidArgumentError(absl::StrCat(specified, ": ", read.status().message()));
    }
    document = *std::move(read);
    found.origin = specified;
  }
  const absl::StatusOr<retargeting::Anatomy> anatomy = retargeting::FindAnatomy(document.skeleton);
  if (!anatomy.ok()) {
    return absl::InvalidArgumentError(absl::StrCat(specified, ": ", anatomy.status().message()));
  }
  found.skeleton = std::move(document.skeleton);
  found.skeleton.hips = anatomy->hips;
  found.skeleton.feet = anatomy->feet;
  found.parts = std::move(document.parts);
  found.hands = anatomy->hands;
  return found;
}

}  // namespace

absl::StatusOr<CaptureSkeleton> FindSkeleton(const fs::path& file, const std::string& specified) {
  if (!specified.empty()) return ReadSpecified(specified);
  DUET_TRY(motion::Skeleton skeleton, ReadCaptured(file));
  return Complete(std::move(skeleton), file.filename().string());
}

}  // namespace duet::importing
