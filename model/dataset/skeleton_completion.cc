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

// Joints and bones alone, for which nothing has to be found; any part will do to read them by.
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

// The one joint that no bone leads to.
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
          "skeleton.root: missing, and no single joint is left that no bone leads to; wanted the "
          "joint that the bones start from");
    }
    object["root"] = *root;
    notes->push_back(absl::StrCat("root: ", *root, " (no bone leads to it)"));
  }
  std::optional<motion::Skeleton> skeleton;
  if (object["root"].is_string()) skeleton = ReadTree(object, object["root"].get<std::string>());
  if (!skeleton) {
    object["parts"] = Json::array();  // whoever reads it meets what is wrong with the rest first
    return object;
  }
  const absl::StatusOr<retargeting::Anatomy> anatomy = retargeting::FindAnatomy(*skeleton);
  if (!anatomy.ok()) {
    return absl::InvalidArgumentError(
        absl::StrCat("skeleton.parts: missing, and not to be found: ", anatomy.status().message(),
                     "; say skeleton.parts, or rename the joints (hips and feet may be said as "
                     "left_hip, right_hip, left_foot, right_foot)"));
  }
  SetPair("hip", anatomy->hips, *skeleton, &object);
  SetPair("foot", anatomy->feet, *skeleton, &object);
  object["parts"] = motion::SkeletonToJson(*skeleton, anatomy->parts)["parts"];
  notes->insert(notes->end(), anatomy->notes.begin(), anatomy->notes.end());
  return object;
}

}  // namespace duet::dataset
