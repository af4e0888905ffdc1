#include "client/cli/skeleton_file.h"

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/motion_input.h"
#include "client/model_skeleton.h"
#include "model/base/file.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
#include "model/motion/motion_limits.h"

namespace duet::client::cli {
namespace {

// As deep as a motion in JSON.
constexpr int kMaxDepth = 8;
constexpr std::size_t kMaxNameBytes = 64;

// An index of a joint, or -1.
int IndexIn(const nlohmann::json& value, std::size_t joints) {
  if (!value.is_number_unsigned() || value.get<std::size_t>() >= joints) return -1;
  return value.get<int>();
}

std::vector<motion::Bone> ReadBones(std::size_t joints, base::ObjectReader* reader) {
  std::vector<motion::Bone> bones;
  for (const nlohmann::json& pair : reader->Array("bones", motion::kMaxFileJoints)) {
    const bool is_pair = pair.is_array() && pair.size() == 2;
    const motion::Bone bone = {is_pair ? IndexIn(pair[0], joints) : -1,
                               is_pair ? IndexIn(pair[1], joints) : -1};
    if (bone.parent < 0 || bone.child < 0) {
      reader->Fail(absl::StrCat("bones[", bones.size(), "]"),
                   absl::StrCat("expected two indices below ", joints, ", got ",
                                is_pair ? pair.dump() : base::Shown(pair)));
      return bones;
    }
    bones.push_back(bone);
  }
  return bones;
}

// The joint that is no bone's child; 0 if there is none.
int RootOf(const std::vector<motion::Bone>& bones, std::size_t joints) {
  std::vector<bool> is_child(joints, false);
  for (const motion::Bone& bone : bones) is_child[static_cast<std::size_t>(bone.child)] = true;
  const auto root = std::find(is_child.begin(), is_child.end(), false);
  return root == is_child.end() ? 0 : static_cast<int>(root - is_child.begin());
}

absl::StatusOr<motion::Skeleton> ParseSkeleton(absl::string_view text) {
  const absl::StatusOr<nlohmann::json> json =
      base::ParseHandwrittenJson(text, kMaxDepth, {"leader", "follower", "rotations"});
  if (!json.ok()) return json.status();
  base::ObjectReader reader(*json, "");
  motion::Skeleton skeleton;
  skeleton.joint_names = reader.UniqueStrings("joint_names", motion::kMaxFileJoints, kMaxNameBytes);
  skeleton.bones = ReadBones(skeleton.joint_names.size(), &reader);
  if (reader.ok()) skeleton.root = RootOf(skeleton.bones, skeleton.joint_names.size());
  if (reader.Has("root_joint")) {
    const std::string root = reader.String("root_joint", kMaxNameBytes);
    skeleton.root = skeleton.Find(root);
    if (skeleton.root < 0) {
      reader.Fail("root_joint",
                  absl::StrCat("expected one of joint_names, got ", base::Quoted(root)));
    }
  }
  if (!reader.ok()) return reader.status();
  absl::Status status = Validate(skeleton);
  if (!status.ok()) return status;
  FindLandmarks(&skeleton);
  return skeleton;
}

}  // namespace

absl::StatusOr<motion::Skeleton> ReadSkeletonFile(const std::filesystem::path& file) {
  const absl::StatusOr<std::string> text =
      base::ReadFile(file, motion::kMaxMotionFileBytes, "a skeleton");
  if (!text.ok()) return text.status();
  absl::StatusOr<motion::Skeleton> skeleton = ParseSkeleton(*text);
  if (skeleton.ok()) return skeleton;
  return absl::InvalidArgumentError(absl::StrCat(file.string(), ": ", skeleton.status().message()));
}

absl::StatusOr<motion::Skeleton> SkeletonOf(const std::filesystem::path& file) {
  if (file.empty()) return motion::SbuSkeleton();
  return ReadSkeletonFile(file);
}

void AddSkeletonFlag(CLI::App* app, std::filesystem::path* file) {
  app->add_option("--skeleton", *file,
                  "Joints to read: a motion in .json, or a model that duet models --json prints "
                  "(default: the 15 joints of sbu)")
      ->type_name("FILE")
      ->group(kInputGroup);
}

}  // namespace duet::client::cli
