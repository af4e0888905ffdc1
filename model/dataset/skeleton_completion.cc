#include "model/dataset/skeleton_completion.h"

#include <cstddef>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/motion/skeleton.h"
#include "model/motion/skeleton_json.h"
#include "model/retargeting/anatomy.h"

namespace duet::dataset {
namespace {

using Json = nlohmann::json;

// Reads only joints and bones, which need no completion. ReadSkeleton requires a part, so the
// document gets an arbitrary one.
std::optional<motion::Skeleton> ReadTree(const Json& object, const std::string& root) {
  Json tree = {{"joint_names", object.value("joint_names", Json())},
               {"bones", object.value("bones", Json())},
               {"root", root},
               {"parts", {{{"name", "all"}, {"joints", {root}}}}}};
  for (const char* key : {"left_hip", "right_hip", "left_foot", "right_foot"}) {
    if (object.contains(key)) tree[key] = object[key];
  }
  absl::StatusOr<motion::SkeletonDocument> read = motion::ReadSkeleton(tree, "skeleton");
  if (!read.ok()) return std::nullopt;
  return std::move(read->skeleton);
}

bool IsPair(const Json& bone) {
  return bone.is_array() && bone.size() == 2 && bone[0].is_string() && bone[1].is_string();
}

// The joint that no bone leads to, if there is exactly one.
std::optional<std::string> FindRoot(const Json& object) {
  const Json names = object.value("joint_names", Json()), bones = object.value("bones", Json());
  if (!names.is_array() || !bones.is_array()) return std::nullopt;
  std::optional<std::string> root;
  for (const Json& name : names) {
    bool is_child = false;
    for (const Json& bone : bones) is_child = is_child || (IsPair(bone) && bone[1] == name);
    if (is_child) continue;
    if (root || !name.is_string()) return std::nullopt;
    root = name.get<std::string>();
  }
  return root;
}

void SetPair(const std::string& what, motion::JointPair pair, const motion::Skeleton& skeleton,
             Json* object) {
  (*object)["left_" + what] = skeleton.joint_names[static_cast<std::size_t>(pair.left)];
  (*object)["right_" + what] = skeleton.joint_names[static_cast<std::size_t>(pair.right)];
}

}  // namespace

absl::StatusOr<Json> CompleteSkeleton(Json object, std::vector<std::string>* notes) {
  if (!object.is_object() || object.contains("parts")) return object;
  if (!object.contains("root")) {
    const std::optional<std::string> root = FindRoot(object);
    if (!root) {
      return absl::InvalidArgumentError(
          "skeleton.root: expected the joint that the bones start from, got none, and the bones "
          "leave no single candidate");
    }
    object["root"] = *root;
    notes->push_back(absl::StrCat("root: ", *root, " (no bone leads to it)"));
  }
  std::optional<motion::Skeleton> skeleton;
  if (object["root"].is_string()) skeleton = ReadTree(object, object["root"].get<std::string>());
  if (!skeleton) {
    object["parts"] = Json::array();  // ReadSkeleton then reports the first error
    return object;
  }
  const absl::StatusOr<retargeting::Anatomy> anatomy = retargeting::FindAnatomy(*skeleton);
  if (!anatomy.ok()) {
    return absl::InvalidArgumentError(
        absl::StrCat("skeleton.parts: expected parts, or joints to infer them from, got ",
                     anatomy.status().message(),
                     "; specify skeleton.parts, or rename the joints (left_hip, right_hip, "
                     "left_foot and right_foot specify hips and feet)"));
  }
  SetPair("hip", anatomy->hips, *skeleton, &object);
  SetPair("foot", anatomy->feet, *skeleton, &object);
  object["parts"] = motion::SkeletonToJson(*skeleton, anatomy->parts)["parts"];
  notes->insert(notes->end(), anatomy->notes.begin(), anatomy->notes.end());
  return object;
}

}  // namespace duet::dataset
