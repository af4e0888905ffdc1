#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/status_macros.h"
#include "model/dataset/layout.h"
#include "model/retargeting/anatomy.h"

namespace duet::dataset {
namespace {

using Json = nlohmann::json;

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

}  // namespace

absl::StatusOr<motion::SkeletonDocument> ReadWrittenSkeleton(Json object,
                                                             std::vector<std::string>* notes) {
  if (!object.is_object() || object.contains("parts")) {
    return motion::ReadSkeleton(object, "skeleton");
  }
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
  // ReadSkeleton requires a part.
  object["parts"] = {{{"name", "all"}, {"joints", object.value("joint_names", Json())}}};
  DUET_TRY(motion::SkeletonDocument document, motion::ReadSkeleton(object, "skeleton"));
  const absl::StatusOr<retargeting::Anatomy> anatomy = retargeting::FindAnatomy(document.skeleton);
  if (!anatomy.ok()) {
    return absl::InvalidArgumentError(
        absl::StrCat("skeleton.parts: expected parts, or joints to infer them from, got ",
                     anatomy.status().message(),
                     "; specify skeleton.parts, or rename the joints (left_hip, right_hip, "
                     "left_foot and right_foot specify hips and feet)"));
  }
  document.skeleton.hips = anatomy->hips;
  document.skeleton.feet = anatomy->feet;
  document.parts = anatomy->parts;
  notes->insert(notes->end(), anatomy->notes.begin(), anatomy->notes.end());
  return document;
}

}  // namespace duet::dataset
