#include "client/cli/request_building.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>
#include <variant>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/batch/level.h"
#include "client/batch/text_values.h"
#include "client/cli/motion_input.h"
#include "client/cli/rig_flags.h"
#include "client/cli/value_syntax.h"
#include "model/base/nearest.h"
#include "model/base/text.h"
#include "model/formats/motion_file.h"
#include "model/motion/inferred_coordinates.h"
#include "model/motion/vertical.h"

namespace duet::client::cli {
namespace {

// The heights of a root joint, as shares of the leader's leg, of a person who sits or leaps.
constexpr double kLowestRoot = 0.3, kHighestRoot = 1.6;

// In the leader's own file, the follower is the other person.
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
  options.format = std::nullopt;  // describes the leader
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

double SecondsOf(const motion::Clip& clip) { return clip.frame_count() / clip.frame_rate_hz; }

// The frame of a position in beats: the nearest one.
absl::StatusOr<int> FrameAt(const motion::Beat& beat, double beats, const motion::Clip& leader) {
  const double frame = std::round(beat.SecondsAt(beats) * leader.frame_rate_hz);
  if (frame >= 0 && frame < leader.frame_count()) return static_cast<int>(frame);
  return absl::InvalidArgumentError(absl::StrCat(
      "--keyframe: expected a beat in the ", SecondsOf(leader), " s of the leader's motion, got ",
      beats, "b, at ", beat.SecondsAt(beats), " s"));
}

absl::StatusOr<std::vector<WeightKeyframe>> ToKeyframes(const SynthesizeArguments& arguments,
                                                        const motion::Clip& leader) {
  std::vector<WeightKeyframe> keyframes;
  for (const KeyframeArgument& keyframe : arguments.keyframes) {
    keyframes.push_back({keyframe.frame, keyframe.weights});
    if (!keyframe.beats) continue;
    const absl::StatusOr<int> frame = FrameAt(*arguments.beat, *keyframe.beats, leader);
    if (!frame.ok()) return frame.status();
    keyframes.back().frame = *frame;
  }
  return keyframes;
}

// A first beat after the end is probably in milliseconds.
absl::Status CheckBeat(const motion::Beat& beat, const motion::Clip& leader) {
  const double seconds = SecondsOf(leader);
  if (beat.first_seconds < seconds) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("--beat: expected the first beat within the ",
                                                 seconds, " s of the leader's motion, got ",
                                                 beat.first_seconds, " s"));
}

// Warns of a start on the floor, such as 0,0,1.2, or in the air: it is the place of the root joint.
void WarnOfHeight(const FollowerStart& start, const motion::Clip& leader,
                  const motion::Skeleton& skeleton, std::vector<std::string>* notes) {
  const motion::Vec3* root = std::get_if<motion::Vec3>(&start);
  if (root == nullptr || notes == nullptr || !skeleton.feet) return;
  float floor = std::numeric_limits<float>::max();
  for (int frame = 0; frame < leader.frame_count(); ++frame) {
    for (const int foot : {skeleton.feet->left, skeleton.feet->right}) {
      floor = std::min(floor, leader.at(frame, foot).y);
    }
  }
  const double leg = LegLength(skeleton, leader.poses);
  const double height = static_cast<double>(root->y - floor);
  if (height >= kLowestRoot * leg && height <= kHighestRoot * leg) return;
  notes->push_back(
      absl::StrFormat("warning: --follower-start: expected Y near %.2f m, where the %s of a "
                      "standing person is, got "
                      "%g: it is a place of that joint, not of the floor",
                      static_cast<double>(floor) + leg,
                      skeleton.joint_names[static_cast<std::size_t>(skeleton.root)], root->y));
}

// A rig from a file of its own, checked before the first call.
absl::StatusOr<formats::FollowerRig> ReadOtherRig(const SynthesizeArguments& arguments,
                                                  const motion::Skeleton& skeleton,
                                                  std::vector<std::string>* notes) {
  RigArguments reading = arguments.rig;
  reading.file = arguments.follower_rig;
  absl::StatusOr<formats::FollowerRig> rig = ReadRigArguments(reading, skeleton);
  if (!rig.ok()) return rig.status();
  std::vector<std::string> remarks;
  rig->reading.notes = &remarks;
  const absl::Status status = formats::CheckRig(*rig);
  if (!status.ok()) return OfRig(status);
  rig->reading.notes = nullptr;
  for (const std::string& remark : remarks) {
    if (notes != nullptr) notes->push_back(absl::StrCat("follower's rig: ", remark));
  }
  return rig;
}

// Everybody whom the camera captured: the leader and, in a file with two people, the other person.
motion::VerticalEstimate EstimateVertical(const motion::Clip& leader, const MotionInput& input,
                                          formats::ReadOptions options, int people) {
  motion::VerticalEvidence evidence(options.skeleton);
  evidence.Add(leader);
  if (people >= 2) {
    options.side = batch::OtherSide(options.side);
    options.notes = nullptr;
    options.report = nullptr;
    const absl::StatusOr<motion::Clip> other = input.Read(options);
    if (other.ok()) evidence.Add(*other);
  }
  return evidence.Estimate();
}

}  // namespace

absl::Status CheckInputs(const SynthesizeArguments& arguments) {
  absl::Status status = CheckInput(arguments.leader, arguments.input.format);
  if (const auto& table = arguments.input.joint_table; status.ok() && !table.empty()) {
    status = CheckExists(table);
  }
  if (const auto& table = arguments.rig.joint_table; status.ok() && !table.empty()) {
    status = CheckExists(table);
  }
  const std::string& start = arguments.follower_start;
  if (!status.ok() || start.empty() || ParsePoint(start).has_value()) return status;
  status = CheckInput(start, std::nullopt);
  if (!absl::IsNotFound(status)) return status;
  return absl::NotFoundError(
      absl::StrCat("--follower-start: ", status.message(), "; expected a motion file or X,Y,Z"));
}

absl::Status CheckLabels(const SynthesizeArguments& arguments, const ModelInfo& model) {
  std::vector<ClassWeight> weights = arguments.weights;
  for (const KeyframeArgument& keyframe : arguments.keyframes) {
    weights.insert(weights.end(), keyframe.weights.begin(), keyframe.weights.end());
  }
  const std::vector<std::string>& known = model.interaction_classes;
  for (const ClassWeight& weight : weights) {
    const std::string& name = weight.interaction_class;
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(arguments.keyframes.empty() ? "--label" : "--keyframe",
                     ": class: expected one of ", model.name, " (", absl::StrJoin(known, ", "),
                     "), got ", base::Quoted(name), base::DidYouMean(name, known)));
  }
  return absl::OkStatus();
}

absl::StatusOr<SynthesisRequest> BuildReaction(const SynthesizeArguments& arguments,
                                               const motion::Skeleton& skeleton) {
  const absl::StatusOr<formats::ReadOptions> options = ToReadOptions(arguments.input, skeleton);
  if (!options.ok()) return options.status();
  SynthesisRequest request;
  static_cast<SynthesisOptions&>(request) = static_cast<const SynthesisOptions&>(arguments);
  if (!arguments.follower_start.empty()) {
    absl::StatusOr<FollowerStart> start = ReadStart(arguments, *options);
    if (!start.ok()) return start.status();
    request.follower_start = *std::move(start);
  }
  request.model = arguments.model;
  request.weights = arguments.weights;
  for (const KeyframeArgument& keyframe : arguments.keyframes) {
    request.keyframes.push_back({keyframe.frame, keyframe.weights});
  }
  return request;
}

absl::StatusOr<SynthesisRequest> BuildRequest(const SynthesizeArguments& arguments,
                                              const motion::Skeleton& skeleton,
                                              std::vector<std::string>* notes, std::istream* in) {
  absl::StatusOr<SynthesisRequest> reaction = BuildReaction(arguments, skeleton);
  if (!reaction.ok()) return reaction.status();
  SynthesisRequest request = *std::move(reaction);
  absl::StatusOr<formats::ReadOptions> read_options = ToReadOptions(arguments.input, skeleton);
  if (!read_options.ok()) return read_options.status();
  formats::ReadOptions options = *std::move(read_options);
  options.side = arguments.leader_side;
  options.notes = notes;
  const absl::StatusOr<MotionInput> input = MotionInput::Open(arguments.leader, in);
  if (!input.ok()) return input.status();
  retargeting::ReadingReport report;
  options.report = &report;
  absl::StatusOr<motion::Clip> leader = input->Read(options);
  if (!leader.ok()) return leader.status();
  request.leader = *std::move(leader);
  const batch::Levelled levelled =
      arguments.level.automatic
          ? batch::LevelBy(EstimateVertical(request.leader, *input, options, report.people))
          : batch::LevelBy(arguments.level);
  request.up = levelled.up;
  if (notes != nullptr && !levelled.note.empty()) notes->push_back(levelled.note);
  if (request.follower_start && !request.up) {
    WarnOfHeight(*request.follower_start, request.leader, skeleton, notes);
  }
  if (arguments.beat) {
    const absl::Status beat = CheckBeat(*arguments.beat, request.leader);
    if (!beat.ok()) return beat;
  }
  absl::StatusOr<std::vector<WeightKeyframe>> keyframes = ToKeyframes(arguments, request.leader);
  if (!keyframes.ok()) return keyframes.status();
  request.keyframes = *std::move(keyframes);
  return request;
}

absl::StatusOr<formats::FollowerRig> BuildFollowerRig(const SynthesizeArguments& arguments,
                                                      const motion::Skeleton& skeleton,
                                                      std::vector<std::string>* notes) {
  if (arguments.follower_rig != kLeadersRig) return ReadOtherRig(arguments, skeleton, notes);
  absl::StatusOr<formats::ReadOptions> reading = ToReadOptions(arguments.input, skeleton);
  if (!reading.ok()) return reading.status();
  formats::FollowerRig rig;
  rig.file = arguments.leader;
  rig.reading = *std::move(reading);
  rig.reading.side = arguments.leader_side;
  return rig;
}

}  // namespace duet::client::cli
