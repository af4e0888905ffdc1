#include "client/cli/request_building.h"

#include <cstddef>
#include <optional>
#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/value_syntax.h"
#include "model/base/file.h"
#include "model/formats/motion_file.h"
#include "model/retargeting/joint_table.h"

namespace duet::client::cli {
namespace {

constexpr std::size_t kMaxTableBytes = std::size_t{1} << 20;

// The joints of the table and of the flags.
absl::StatusOr<retargeting::JointOverrides> ReadJoints(const InputArguments& input) {
  retargeting::JointOverrides joints = input.joints;
  if (input.joint_table.empty()) return joints;
  const absl::StatusOr<std::string> text =
      base::ReadFile(input.joint_table, kMaxTableBytes, "a table of joints");
  if (!text.ok()) return text.status();
  absl::StatusOr<retargeting::JointOverrides> table =
      retargeting::ParseJointTable(*text, input.joint_table.string());
  if (!table.ok()) return table.status();
  joints.merge(*std::move(table));  // keeps those of the flags
  return joints;
}

absl::StatusOr<formats::ReadOptions> ToReadOptions(const InputArguments& input,
                                                   const motion::Skeleton& skeleton) {
  formats::ReadOptions options;
  options.skeleton = skeleton;
  options.frame_rate_hz = input.frame_rate_hz;
  options.metres_per_unit = input.metres_per_unit;
  absl::StatusOr<retargeting::JointOverrides> joints = ReadJoints(input);
  if (!joints.ok()) return joints.status();
  options.joint_overrides = *std::move(joints);
  options.coordinates = motion::StatedCoordinates(input.unit, input.up_axis);
  return options;
}

absl::Status CheckExists(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::exists(path, error)) return absl::OkStatus();
  return absl::NotFoundError(absl::StrCat(path.string(), ": no such file"));
}

absl::Status CheckInput(const std::filesystem::path& path) {
  absl::Status status = CheckExists(path);
  if (!status.ok()) return status;
  if (formats::IsReadable(path)) return absl::OkStatus();
  return formats::UnknownExtension(path, formats::kReadableExtensions);
}

// Of the leader's own file, the follower is the other person.
formats::Side FollowerStartSide(const SynthesizeArguments& arguments) {
  if (arguments.follower_start_side.has_value()) return *arguments.follower_start_side;
  std::error_code error;
  if (!std::filesystem::equivalent(arguments.follower_start, arguments.leader, error)) {
    return kDefaultSide;
  }
  return arguments.leader_side == formats::Side::kLeft ? formats::Side::kRight
                                                       : formats::Side::kLeft;
}

absl::StatusOr<FollowerStart> ReadStart(const SynthesizeArguments& arguments,
                                        formats::ReadOptions options) {
  if (const std::optional<motion::Vec3> root = ParsePoint(arguments.follower_start);
      root.has_value()) {
    return FollowerStart(*root);
  }
  options.side = FollowerStartSide(arguments);
  absl::StatusOr<std::vector<motion::Vec3>> pose =
      ReadFollowerStart(arguments.follower_start, options);
  if (!pose.ok()) return pose.status();
  return FollowerStart(*std::move(pose));
}

}  // namespace

absl::Status CheckInputs(const SynthesizeArguments& arguments) {
  absl::Status status = CheckInput(arguments.leader);
  if (const auto& table = arguments.input.joint_table; status.ok() && !table.empty()) {
    status = CheckExists(table);
  }
  const std::string& start = arguments.follower_start;
  if (!status.ok() || start.empty() || ParsePoint(start).has_value()) return status;
  return CheckInput(start);
}

absl::StatusOr<SynthesisRequest> BuildRequest(const SynthesizeArguments& arguments,
                                              const motion::Skeleton& skeleton,
                                              std::vector<std::string>* notes) {
  absl::StatusOr<formats::ReadOptions> read_options = ToReadOptions(arguments.input, skeleton);
  if (!read_options.ok()) return read_options.status();
  formats::ReadOptions options = *std::move(read_options);
  SynthesisRequest request;
  if (!arguments.follower_start.empty()) {
    absl::StatusOr<FollowerStart> start = ReadStart(arguments, options);
    if (!start.ok()) return start.status();
    request.follower_start = *std::move(start);
  }
  options.side = arguments.leader_side;
  options.notes = notes;
  absl::StatusOr<motion::Clip> leader = ReadLeader(arguments.leader, options);
  if (!leader.ok()) return leader.status();
  request.leader = *std::move(leader);
  request.model = arguments.model;
  request.weights = arguments.weights;
  request.keyframes = arguments.keyframes;
  request.partner_direction = arguments.partner_direction;
  request.seed = arguments.seed;
  request.variety = arguments.variety;
  request.clean_up = arguments.clean_up;
  request.priority = arguments.priority;
  request.chunk_frames = arguments.chunk_frames;
  request.request_id = arguments.request_id;
  return request;
}

}  // namespace duet::client::cli
