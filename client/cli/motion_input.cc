#include "client/cli/motion_input.h"

#include <cstddef>
#include <filesystem>
#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/file.h"
#include "model/base/missing_file.h"
#include "model/motion/inferred_coordinates.h"
#include "model/motion/motion_limits.h"
#include "model/motion/reading_setting.h"
#include "model/motion/stated_unit.h"
#include "model/retargeting/joint_table.h"

namespace duet::client::cli {
namespace {

constexpr std::size_t kMaxTableBytes = std::size_t{1} << 20;
// The legs of a small child and of a giant, metres.
constexpr double kShortestLikelyLeg = 0.2, kLongestLikelyLeg = 4;
constexpr char kStandardInput[] = "standard input";

absl::StatusOr<std::string> ReadWhole(std::istream* in) {
  std::string content;
  if (in == nullptr) return content;
  std::string block(std::size_t{1} << 16, '\0');
  while (in->read(block.data(), static_cast<std::streamsize>(block.size())) || in->gcount() > 0) {
    content.append(block, 0, static_cast<std::size_t>(in->gcount()));
    if (content.size() > motion::kMaxMotionFileBytes) {
      return absl::InvalidArgumentError(
          absl::StrCat(kStandardInput, ": expected a motion of at most ",
                       motion::kMaxMotionFileBytes >> 20, " MiB, got more"));
    }
  }
  return content;
}

// A stated unit may be wrong. An inferred one always gives the legs of a person.
void WarnOfSize(const motion::Clip& clip, const formats::ReadOptions& options) {
  if (!options.skeleton.feet) return;
  const double leg = LegLength(options.skeleton, clip.poses);
  if (leg >= kShortestLikelyLeg && leg <= kLongestLikelyLeg) return;
  const std::optional<motion::InferredUnit> unit = motion::InferUnit({leg});
  const std::string warning = absl::StrCat(
      "warning: size: as the file was read, the distance from foot to ",
      options.skeleton.joint_names[static_cast<std::size_t>(options.skeleton.root)], " is ",
      absl::StrFormat("%.3g", leg), " m; ",
      unit.has_value() ? absl::StrCat(unit->name, " would fit; ") : "", "specify the unit");
  if (options.notes != nullptr) options.notes->push_back(warning);
  if (options.report != nullptr) options.report->remarks.push_back(warning);
}

}  // namespace

absl::StatusOr<MotionInput> MotionInput::Open(const std::filesystem::path& path, std::istream* in) {
  MotionInput input;
  input.name_ = path.string();
  if (path != kStandardStream) return input;
  input.name_ = kStandardInput;
  absl::StatusOr<std::string> content = ReadWhole(in);
  if (!content.ok()) return content.status();
  if (content->empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat(kStandardInput, ": expected a motion, got no data"));
  }
  input.content_ = *std::move(content);
  return input;
}

absl::StatusOr<motion::Clip> MotionInput::Read(const formats::ReadOptions& options) const {
  absl::StatusOr<motion::Clip> clip = content_.has_value()
                                          ? formats::ParseLeader(*content_, name_, options)
                                          : formats::ReadLeader(name_, options);
  if (clip.ok()) WarnOfSize(*clip, options);
  return clip;
}

absl::StatusOr<formats::ReadPeople> ReadAllPeople(const MotionInput& input,
                                                  const formats::ReadOptions& options) {
  return formats::ReadAllPeople(
      [&input](const formats::ReadOptions& person) { return input.Read(person); }, options);
}

absl::StatusOr<retargeting::JointOverrides> ReadJoints(retargeting::JointOverrides joints,
                                                       const std::filesystem::path& table_file) {
  if (table_file.empty()) return joints;
  const absl::StatusOr<std::string> text =
      base::ReadFile(table_file, kMaxTableBytes, "a table of joints");
  if (!text.ok()) return text.status();
  absl::StatusOr<retargeting::JointOverrides> table =
      retargeting::ParseJointTable(*text, table_file.string());
  if (!table.ok()) return table.status();
  joints.merge(*std::move(table));  // keeps the joints of --joint-map
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
  absl::StatusOr<retargeting::JointOverrides> joints = ReadJoints(input.joints, input.joint_table);
  if (!joints.ok()) return joints.status();
  options.joint_overrides = *std::move(joints);
  options.coordinates = motion::StatedCoordinates(input.unit, input.up_axis);
  return options;
}

absl::Status CheckExists(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::exists(path, error)) return absl::OkStatus();
  return base::MissingFile(path);
}

absl::Status CheckInput(const std::filesystem::path& path,
                        const std::optional<formats::Format>& format) {
  if (path == kStandardStream) {
    if (format.has_value()) return absl::OkStatus();
    return MendedBy(absl::InvalidArgumentError(absl::StrCat(
                        kStandardInput, ": format: expected --input-format, got none")),
                    motion::ReadingSetting::kFormat);
  }
  return formats::CheckReadable(path, format);
}

}  // namespace duet::client::cli
