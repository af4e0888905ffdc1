#include "client/cli/live_ends.h"

#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/leader_watch.h"
#include "client/cli/live_file_sink.h"
#include "client/cli/motion_input.h"
#include "client/cli/output.h"
#include "client/cli/request_building.h"
#include "client/live/clip_source.h"
#include "client/live/json_lines_sink.h"
#include "client/live/json_lines_source.h"
#include "client/live/line_reader.h"
#include "model/formats/motion_file.h"

namespace duet::client::cli {
namespace {

LiveRequest ToLiveRequest(SynthesisRequest request, const LiveArguments& arguments) {
  LiveRequest live;
  static_cast<ReactionOptions&>(live) = static_cast<const ReactionOptions&>(request);
  live.model = std::move(request.model);
  live.weights = std::move(request.weights);
  live.keyframes = std::move(request.keyframes);
  live.follower_start = std::move(request.follower_start);
  live.delay_frames = arguments.delay_frames;
  live.plan_frames = arguments.plan_frames;
  return live;
}

absl::StatusOr<LiveInput> OpenFile(const LiveArguments& arguments,
                                   const motion::Skeleton& skeleton) {
  std::vector<std::string> notes;
  absl::StatusOr<SynthesisRequest> request = BuildRequest(arguments, skeleton, &notes);
  if (!request.ok()) return request.status();
  LiveInput input;
  input.source = std::make_unique<live::ClipSource>(std::move(request->leader), arguments.realtime,
                                                    std::move(notes));
  input.request = ToLiveRequest(*std::move(request), arguments);
  return input;
}

absl::StatusOr<LiveInput> OpenStandardInput(const LiveArguments& arguments,
                                            const motion::Skeleton& skeleton,
                                            const ProgramEnvironment& environment) {
  if (environment.in == nullptr) {
    return absl::InvalidArgumentError("--from -: expected a standard input, got none");
  }
  absl::StatusOr<SynthesisRequest> request = BuildReaction(arguments, skeleton);
  if (!request.ok()) return request.status();
  absl::StatusOr<retargeting::JointOverrides> joints =
      ReadJoints(arguments.input.joints, arguments.input.joint_table);
  if (!joints.ok()) return joints.status();
  LiveInput input;
  input.source = std::make_unique<live::JsonLinesSource>(
      environment.in_descriptor.has_value() ? live::ReadLinesOf(*environment.in_descriptor)
                                            : live::ReadLinesOf(*environment.in),
      live::JsonLinesOptions{skeleton, *std::move(joints), arguments.realtime});
  input.request = ToLiveRequest(*std::move(request), arguments);
  return input;
}

}  // namespace

bool IsFile(const std::string& value) { return value != kStandardStream; }

absl::StatusOr<LiveInput> OpenSource(const LiveArguments& arguments,
                                     const motion::Skeleton& skeleton,
                                     const ProgramEnvironment& environment,
                                     const std::function<void(const std::string&)>& on_note) {
  absl::StatusOr<LiveInput> input = IsFile(arguments.from)
                                        ? OpenFile(arguments, skeleton)
                                        : OpenStandardInput(arguments, skeleton, environment);
  if (!input.ok()) return input;
  input->source = std::make_unique<LeaderWatch>(std::move(input->source), skeleton, on_note);
  return input;
}

absl::Status CheckSink(const std::string& to, const LiveArguments& arguments) {
  if (!IsFile(to)) return absl::OkStatus();
  if (formats::FormatOf(to) == formats::Format::kSbuText) {
    return absl::InvalidArgumentError(
        absl::StrCat(to, ": expected a format that can hold one person, got SBU text"));
  }
  return CheckOutput(to, {IsFile(arguments.from) ? arguments.from : "", arguments.follower_start});
}

absl::StatusOr<std::unique_ptr<live::FollowerSink>> OpenSink(
    const std::string& to, const LiveArguments& arguments, const motion::Skeleton& skeleton,
    const ProgramEnvironment& environment) {
  if (!IsFile(to)) return std::make_unique<live::JsonLinesSink>(*environment.out);
  return std::make_unique<LiveFileSink>(to, arguments, skeleton);
}

}  // namespace duet::client::cli
