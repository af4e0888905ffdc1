#include "model/formats/asf/amc_import.h"

#include <cstddef>
#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/file.h"
#include "model/motion/motion_limits.h"
#include "model/retargeting/rest_pose.h"
#include "model/retargeting/rest_rig.h"

namespace duet::formats::asf {
namespace {

constexpr double kCmuFrameRateHz = 120;
constexpr double kInch = 0.0254;  // metres

retargeting::JointTree TreeOf(const AsfSkeleton& skeleton, const std::vector<int>& ends) {
  retargeting::JointTree tree;
  for (const AsfBone& bone : skeleton.bones) {
    tree.names.push_back(bone.name);
    tree.parents.push_back(bone.parent);
    tree.offsets.push_back(bone.parent < 0
                               ? retargeting::Vec3d{}
                               : skeleton.bones[static_cast<size_t>(bone.parent)].extent);
  }
  for (int end : ends) {
    const AsfBone& bone = skeleton.bones[static_cast<size_t>(end)];
    tree.names.push_back(bone.name + ".end");
    tree.parents.push_back(end);
    tree.offsets.push_back(bone.extent);
  }
  return tree;
}

}  // namespace

absl::StatusOr<motion::Clip> FromAmc(const AsfSkeleton& skeleton, const AmcMotion& motion,
                                     absl::string_view source, const AmcImportOptions& options) {
  const AsfKinematics kinematics(skeleton, motion);
  retargeting::Character character;
  character.tree = TreeOf(skeleton, kinematics.ends());
  character.frame_count = motion.frame_count;
  character.frame_rate_hz = options.frame_rate_hz.value_or(kCmuFrameRateHz);
  if (skeleton.units_per_inch.has_value()) {
    character.stated_metres_per_unit = kInch / *skeleton.units_per_inch;
    character.stated_by = absl::StrCat(":units length ", *skeleton.units_per_inch);
  }
  character.pose = [&kinematics](int frame) {
    std::vector<motion::Vec3> pose;
    for (const retargeting::Vec3d& at : kinematics.Positions(frame)) pose.push_back(ToFloat(at));
    return pose;
  };
  if (options.report != nullptr) {
    options.report->people = 1;
    options.report->frame_rate =
        retargeting::Setting{absl::StrCat(character.frame_rate_hz, " Hz"),
                             retargeting::Origin::kDefault, "as CMU's captures have"};
  }
  if (options.notes != nullptr && !options.frame_rate_hz.has_value()) {
    options.notes->push_back(
        absl::StrCat("frame rate: ", kCmuFrameRateHz, " Hz, as CMU's captures have"));
  }
  return ToClip(character, source, options);
}

absl::StatusOr<retargeting::CharacterRig> AmcRig(const AsfSkeleton& skeleton,
                                                 const AmcMotion& motion, absl::string_view source,
                                                 const AmcImportOptions& options) {
  retargeting::CharacterFit fit;
  AmcImportOptions reading = options;
  reading.fit = &fit;
  const absl::StatusOr<motion::Clip> read = FromAmc(skeleton, motion, source, reading);
  if (!read.ok()) return read.status();
  const AsfKinematics kinematics(skeleton, motion);
  const retargeting::JointTree tree = TreeOf(skeleton, kinematics.ends());
  retargeting::CharacterRig rig = RestRig(tree, fit);
  const absl::StatusOr<std::optional<int>> frame = retargeting::FindRestFrame(rig, *read, source);
  if (!frame.ok()) return frame.status();
  if (!frame->has_value()) return rig;
  NoteRestFrame(**frame, options);
  return RestRig(tree, fit, kinematics.Positions(**frame));
}

absl::StatusOr<AsfSkeleton> ReadSkeletonBeside(const std::filesystem::path& motion_file) {
  const std::vector<std::string> names = SkeletonNames(motion_file.filename().string());
  for (const std::string& name : names) {
    const std::filesystem::path path = motion_file.parent_path() / name;
    const absl::StatusOr<std::string> text =
        base::ReadFile(path, motion::kMaxMotionFileBytes, "a skeleton");
    if (absl::IsNotFound(text.status())) continue;
    if (!text.ok()) return text.status();
    return ParseAsf(*text, path.string());
  }
  return absl::NotFoundError(absl::StrCat(motion_file.string(), ": skeleton: expected ",
                                          absl::StrJoin(names, " or "),
                                          " in the same folder, got neither"));
}

std::vector<std::string> SkeletonNames(absl::string_view motion_name) {
  const absl::string_view stem = motion_name.substr(0, motion_name.rfind('.'));
  std::vector<std::string> names = {absl::StrCat(stem, ".asf")};
  const std::size_t subject = stem.rfind('_');
  if (subject != absl::string_view::npos && subject > 0) {
    names.push_back(absl::StrCat(stem.substr(0, subject), ".asf"));
  }
  return names;
}

}  // namespace duet::formats::asf
