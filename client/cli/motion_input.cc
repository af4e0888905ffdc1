#include "client/cli/motion_input.h"

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "client/cli/flags.h"
#include "client/model_skeleton.h"
#include "model/base/file.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
#include "model/motion/coordinates.h"
#include "model/motion/inferred_coordinates.h"
#include "model/motion/motion_limits.h"
#include "model/retargeting/joint_mapping.h"

namespace duet::client::cli {
namespace {

constexpr std::size_t kMaxTableBytes = std::size_t{1} << 20;
// The legs of a small child and of a giant, metres.
constexpr double kShortestLikelyLeg = 0.2, kLongestLikelyLeg = 4;
// Of a skeleton in JSON, which is as deep as a motion.
constexpr int kMaxDepth = 8;
constexpr std::size_t kMaxNameBytes = 64;

// The value that a parser of names found.
template <typename T>
absl::StatusOr<T> Known(const std::optional<T>& value, absl::string_view names,
                        absl::string_view text) {
  if (value.has_value()) return *value;
  return absl::InvalidArgumentError(absl::StrCat("expected ", names, ", got ", base::Quoted(text)));
}

absl::StatusOr<formats::Format> ParseInputFormat(absl::string_view text) {
  return Known(formats::ParseFormat(text), formats::kReadableFormatNames, text);
}

absl::StatusOr<motion::LengthUnit> ParseUnit(absl::string_view text) {
  return Known(motion::ParseLengthUnit(text), motion::kLengthUnitNames, text);
}

// A stated unit may be wrong. An inferred one always gives the legs of a person.
void WarnOfSize(const motion::Clip& clip, const formats::ReadOptions& options) {
  if (!options.skeleton.feet || options.report == nullptr) return;
  const double leg = LegLength(options.skeleton, clip.poses);
  if (leg >= kShortestLikelyLeg && leg <= kLongestLikelyLeg) return;
  const std::optional<motion::InferredUnit> unit = motion::InferUnit({leg});
  const std::string warning = absl::StrCat(
      "warning: size: as the file was read, the distance from foot to ",
      options.skeleton.joint_names[static_cast<std::size_t>(options.skeleton.root)], " is ",
      absl::StrFormat("%.3g", leg), " m; ",
      unit.has_value() ? absl::StrCat(unit->name, " would fit; ") : "", "specify the unit");
  options.report->remarks.push_back(warning);
}

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
  if (!reader.ok()) return reader.status();
  absl::Status status = Validate(skeleton);
  if (!status.ok()) return status;
  FindLandmarks(&skeleton);
  return skeleton;
}

}  // namespace

absl::StatusOr<motion::UpAxis> ParseAxis(absl::string_view text) {
  return Known(motion::ParseUpAxis(text), motion::kUpAxisNames, text);
}

void AddReadingFlags(CLI::App* app, InputArguments* input) {
  AddParsed(app, kInputGroup, "--input-format", "FORMAT", ParseInputFormat, &input->format,
            absl::StrCat("Format of the input: ", formats::kReadableFormatNames,
                         "; overrides the extension"));
  AddValue(app, kInputGroup, "--frame-rate", "HZ", &input->frame_rate_hz,
           "Frame rate of the input; overrides the file")
      ->check(AboveZero());
  AddValue(app, kInputGroup, "--metres-per-unit", "METRES", &input->metres_per_unit,
           "Metres in one unit of the file (0.01 for centimetres); overrides the file")
      ->check(AboveZero());
  AddValue(app, kInputGroup, "--joint-map", "MODEL_JOINT=FILE_JOINT|FILE", &input->joint_map,
           "Joint of the file for a joint of the model, if its name is not recognised, or a "
           "file with one such pair on each line; repeatable")
      ->allow_extra_args(false);
}

void AddInputFlags(CLI::App* app, InputArguments* input) {
  AddReadingFlags(app, input);
  AddParsed(app, kInputGroup, "--unit", "metres|millimetres|sbu-normalised", ParseUnit,
            &input->unit, "Unit of positions; overrides the file");
  AddParsed(app, kInputGroup, "--up-axis", "y-up|z-up|y-down", ParseAxis, &input->up_axis,
            "Up axis of positions; overrides the file");
  AddValue(app, kInputGroup, "--animation", "NAME", &input->animation,
           "The animation of a file with several (default: the first that moves the person)");
}

absl::StatusOr<motion::Clip> ReadMotion(const std::filesystem::path& file,
                                        const formats::ReadOptions& options) {
  absl::StatusOr<motion::Clip> clip = formats::ReadLeader(file, options);
  if (clip.ok()) WarnOfSize(*clip, options);
  return clip;
}

absl::StatusOr<ReadPeople> ReadAllPeople(const std::filesystem::path& file,
                                         const formats::ReadOptions& options) {
  absl::Status status = formats::CheckReadable(file, options.format);
  if (!status.ok()) return status;
  ReadPeople all;
  retargeting::ReadingReport report;
  formats::ReadOptions reading = options;
  reading.report = &report;
  for (const formats::Side side : {formats::Side::kLeft, formats::Side::kRight}) {
    reading.side = side;
    absl::StatusOr<motion::Clip> person = ReadMotion(file, reading);
    if (!person.ok()) return person.status();
    all.people.push_back(*std::move(person));
    if (side == formats::Side::kLeft) all.notes = report.Notes();
    if (report.people < 2) break;
    reading.report = nullptr;
  }
  return all;
}

absl::StatusOr<retargeting::JointOverrides> ReadJoints(const std::vector<std::string>& joint_map) {
  retargeting::JointOverrides joints, from_files;
  for (const std::string& word : joint_map) {
    if (absl::StrContains(word, '=')) {
      std::pair<std::string, std::string> pair = absl::StrSplit(word, absl::MaxSplits('=', 1));
      if (pair.first.empty() || pair.second.empty()) {
        return absl::InvalidArgumentError(
            absl::StrCat("--joint-map: expected MODEL_JOINT=FILE_JOINT such as "
                         "left_hand=LeftWrist, got ",
                         base::Quoted(word)));
      }
      joints.insert(std::move(pair));
      continue;
    }
    const absl::StatusOr<std::string> text =
        base::ReadFile(word, kMaxTableBytes, "a table of joints");
    if (!text.ok()) return text.status();
    absl::StatusOr<retargeting::JointOverrides> table = retargeting::ParseJointTable(*text, word);
    if (!table.ok()) return table.status();
    from_files.merge(*std::move(table));
  }
  joints.merge(std::move(from_files));  // keeps the pairs
  return joints;
}

absl::StatusOr<formats::ReadOptions> ToReadOptions(const InputArguments& input,
                                                   const motion::Skeleton& skeleton) {
  formats::ReadOptions options;
  options.format = input.format;
  options.skeleton = skeleton;
  options.frame_rate_hz = input.frame_rate_hz;
  options.metres_per_unit = motion::StatedMetresPerUnit(input.metres_per_unit, input.unit);
  options.animation = input.animation;
  absl::StatusOr<retargeting::JointOverrides> joints = ReadJoints(input.joint_map);
  if (!joints.ok()) return joints.status();
  options.joint_overrides = *std::move(joints);
  options.coordinates = motion::StatedCoordinates(input.unit, input.up_axis);
  return options;
}

absl::StatusOr<motion::Skeleton> SkeletonOf(const std::filesystem::path& file) {
  if (file.empty()) return motion::SbuSkeleton();
  const absl::StatusOr<std::string> text =
      base::ReadFile(file, motion::kMaxMotionFileBytes, "a skeleton");
  if (!text.ok()) return text.status();
  absl::StatusOr<motion::Skeleton> skeleton = ParseSkeleton(*text);
  if (skeleton.ok()) return skeleton;
  return absl::InvalidArgumentError(absl::StrCat(file.string(), ": ", skeleton.status().message()));
}

void AddSkeletonFlag(CLI::App* app, std::filesystem::path* file) {
  AddValue(app, kInputGroup, "--skeleton", "FILE", file,
           "Joints to read: a motion in .json, or a model that duet models --json prints "
           "(default: the 15 joints of sbu)");
}

}  // namespace duet::client::cli
