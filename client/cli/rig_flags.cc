#include "client/cli/rig_flags.h"

#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/flags.h"
#include "client/cli/input_flags.h"
#include "client/cli/motion_input.h"
#include "client/cli/value_syntax.h"
#include "model/motion/reading_setting.h"

namespace duet::client::cli {

void AddRigFlags(FlagSet* app, RigArguments* rig) {
  Flag* file = app->Add("--rig", &rig->file,
                        "Rig of the person in --out FILE.bvh, FILE.glb and FILE.gltf: the rig of "
                        "another .bvh, .glb or .gltf (default: Duet's rig)")
                   ->Form("FILE")
                   ->Group(kOutputGroup);
  AddChoice<formats::Side>(
      app, "--rig-side", kSides, [rig](formats::Side side) { rig->side = side; },
      "The person in a --rig file with two people (default: left)")
      ->Needs(file)
      ->Group(kOutputGroup);
  for (Flag* flag : AddRigReadingFlags(app, "--rig", "the rig", rig)) flag->Needs(file);
}

std::vector<Flag*> AddRigReadingFlags(FlagSet* app, const std::string& prefix,
                                      const std::string& what, RigArguments* rig) {
  const std::vector<Flag*> flags = {
      AddParsed<motion::UpAxis>(
          app, absl::StrCat(prefix, "-up-axis"), "y-up|z-up|y-down", ParseAxis,
          [rig](motion::UpAxis axis) { rig->up_axis = axis; },
          absl::StrCat("Up axis of ", what, "; overrides the file"))
          ->LastOnly(),
      app->Add(absl::StrCat(prefix, "-metres-per-unit"), &rig->metres_per_unit,
               absl::StrCat("Metres in one unit of ", what, " (0.01 for centimetres)"))
          ->AboveZero()
          ->Form("METRES"),
      AddParsed<std::pair<std::string, std::string>>(
          app, absl::StrCat(prefix, "-joint-map"), "MODEL_JOINT=RIG_JOINT", ParseJointPair,
          [rig](std::pair<std::string, std::string> joints) {
            rig->joints.insert(std::move(joints));
          },
          absl::StrCat("Joint of ", what,
                       " for a joint of the model, if its name is not recognised; repeatable")),
      app->Add(absl::StrCat(prefix, "-joint-map-file"), &rig->joint_table,
               absl::StrCat("File with one MODEL_JOINT=RIG_JOINT on each line; ", prefix,
                            "-joint-map overrides it"))
          ->Form("FILE")};
  for (Flag* flag : flags) flag->Group(kOutputGroup);
  return flags;
}

void CheckRigFlags(const RigArguments& rig, const std::vector<std::filesystem::path>& outputs) {
  if (rig.file.empty()) return;
  const std::optional<formats::Format> format = formats::FormatOf(rig.file);
  if (!format || !formats::HasRig(*format)) {
    RejectFlag("--rig",
               absl::StrCat("expected ", formats::kRigExtensions, ", got ", rig.file.string()));
  }
  for (const std::filesystem::path& output : outputs) {
    const std::optional<formats::Format> written = formats::FormatOf(output);
    if (written && formats::FitsRig(*written, *format)) continue;
    RejectFlag("--out", absl::StrCat("expected the format of --rig, got ", output.string()));
  }
}

absl::StatusOr<formats::FollowerRig> ReadRigArguments(const RigArguments& arguments,
                                                      const motion::Skeleton& skeleton) {
  formats::FollowerRig rig;
  rig.file = arguments.file;
  rig.reading.skeleton = skeleton;
  rig.reading.side = arguments.side.value_or(formats::Side::kLeft);
  rig.reading.metres_per_unit = arguments.metres_per_unit;
  if (arguments.up_axis) {
    rig.reading.coordinates = motion::Coordinates{motion::LengthUnit::kMetres, *arguments.up_axis};
  }
  absl::StatusOr<retargeting::JointOverrides> joints =
      ReadJoints(arguments.joints, arguments.joint_table);
  if (!joints.ok()) return joints.status();
  rig.reading.joint_overrides = *std::move(joints);
  return rig;
}

absl::Status OfRig(const absl::Status& status) {
  if (motion::MendingSetting(status) != motion::ReadingSetting::kJointMap) return status;
  return MendedBy(status, motion::ReadingSetting::kRigJointMap);
}

}  // namespace duet::client::cli
