#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/time/time.h"
#include "client/cli/command.h"
#include "client/cli/flags.h"
#include "client/cli/output.h"
#include "client/cli/reaction.h"
#include "client/cli/server.h"
#include "client/cli/stop_signals.h"
#include "client/live/json_lines.h"
#include "client/live/live_run.h"
#include "client/model_skeleton.h"
#include "model/base/counted.h"
#include "model/base/program_flags.h"
#include "model/formats/motion_file.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::cli {
namespace {

// Standard input or output in place of a file.
constexpr char kStandardStream[] = "-";

std::ptrdiff_t CountOf(const std::string& word, const std::vector<std::string>& words) {
  return std::count(words.begin(), words.end(), word);
}

// `leader` is the file of --from, if it is one.
struct LiveArguments : ReactionArguments {
  ServerArguments server;
  std::string from;
  std::vector<std::string> to;
  bool realtime = false;
  int delay_frames = 0;
  bool quiet = false;
};

// Keeps a whole session, and writes it at its end: the follower alone to a motion file, both people
// to a page. Files name the labels of the beginning, not later changes. A file that cannot be
// created is reported at the start, before any motion would be lost.
class LiveFileSink final : public live::FollowerSink {
 public:
  // `leader` names the leader in the file.
  LiveFileSink(std::filesystem::path path, std::filesystem::path leader, SynthesisRequest request,
               motion::Skeleton skeleton)
      : path_(std::move(path)),
        leader_file_(std::move(leader)),
        request_(std::move(request)),
        skeleton_(std::move(skeleton)) {}

  absl::Status Start(const live::LeaderFormat& format) override {
    leader_.joint_names = format.joint_names;
    leader_.frame_rate_hz = format.frame_rate_hz;
    leader_.poses = motion::Poses(0, leader_.joint_count());
    follower_ = leader_;
    return CheckCanCreate(path_);
  }

  absl::Status Accept(const LiveFrames& frames) override {
    follower_.Append(frames.poses.all());
    return absl::OkStatus();
  }

  void AcceptLeader(const live::LeaderFrame& frame) override {
    const int end = leader_.frame_count();
    if (frame.index < end) return;
    // Lost frames, which the server interpolates too.
    for (int lost = end; lost < frame.index && end > 0; ++lost) {
      const float share =
          static_cast<float>(lost - end + 1) / static_cast<float>(frame.index - end + 1);
      std::vector<motion::Vec3> pose(frame.positions.size());
      for (std::size_t joint = 0; joint < pose.size(); ++joint) {
        pose[joint] = Lerp(leader_.poses[end - 1][joint], frame.positions[joint], share);
      }
      leader_.Append(pose);
    }
    leader_.Append(frame.positions);
  }

  absl::StatusOr<std::vector<std::string>> Finish(const LiveInfo& info) override {
    const int frames = std::min(leader_.frame_count(), follower_.frame_count());
    if (frames == 0) {
      return std::vector<std::string>{absl::StrCat(path_.string(), ": not written, no frames")};
    }
    leader_.poses.Resize(frames);
    follower_.poses.Resize(frames);
    Synthesis synthesis;
    synthesis.request = request_;
    synthesis.result.pair = {std::move(leader_), std::move(follower_)};
    synthesis.result.model_name = info.model_name;
    synthesis.result.model_version = info.model_version;
    synthesis.result.seed = info.seed;
    synthesis.result.variety = info.variety;
    synthesis.result.candidates = info.candidates;
    synthesis.result.cleaned_up = info.cleaned_up;
    synthesis.skeleton = skeleton_;
    synthesis.leader_file = leader_file_;
    synthesis.sampled = true;
    const absl::Status written = WriteFollower(path_, synthesis);
    if (!written.ok()) return NotWritten(written);
    return std::vector<std::string>{path_.string()};
  }

 private:
  const std::filesystem::path path_;
  const std::filesystem::path leader_file_;
  const SynthesisRequest request_;
  const motion::Skeleton skeleton_;
  motion::Clip leader_, follower_;
};

// Prints what happened to the connection.
void ShowNotice(const LiveNotice& notice, std::ostream& err) {
  switch (notice.kind) {
    case LiveNotice::Kind::kDraining:
      err << "duet: the server shuts down; moving to another one\n" << std::flush;
      return;
    case LiveNotice::Kind::kInterrupted:
      err << "duet: " << notice.message << "; resuming\n" << std::flush;
      return;
    case LiveNotice::Kind::kResumed:
      err << "duet: resumed\n" << std::flush;
      return;
    default:  // counted
      return;
  }
}

// Rejects the fields of a request that only a whole clip has.
absl::Status CheckLiveFields(const SynthesisRequest& request) {
  const char* field = !request.constraints.empty()          ? "constraints"
                      : request.rotations                   ? "reply_rotations"
                      : request.chunk_frames                ? "chunk_frames"
                      : request.priority == Priority::kBulk ? "priority"
                                                            : nullptr;
  if (field == nullptr) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat(field, ": expected none in the request of duet live, got one"));
}

LiveRequest ToLiveRequest(const SynthesisRequest& request, const LiveArguments& arguments) {
  LiveRequest live;
  static_cast<ReactionOptions&>(live) = static_cast<const ReactionOptions&>(request);
  live.model = request.model;
  live.weights = request.weights;
  live.keyframes = request.keyframes;
  live.follower_start = request.follower_start;
  live.delay_frames = arguments.delay_frames;
  return live;
}

// Reads the motions that `request` needs, and opens the source of --from.
absl::StatusOr<std::unique_ptr<live::LeaderSource>> OpenSource(
    const LiveArguments& arguments, const motion::Skeleton& skeleton,
    const ProgramEnvironment& environment, SynthesisRequest* request) {
  std::vector<std::string> notes;
  const absl::Status status = ReadMotions(arguments, skeleton, request, &notes);
  if (!status.ok()) return status;
  if (!arguments.leader.empty()) {
    return std::make_unique<live::ClipSource>(std::move(request->leader), arguments.realtime,
                                              std::move(notes));
  }
  absl::StatusOr<retargeting::JointOverrides> joints = ReadJoints(arguments.input.joint_map);
  if (!joints.ok()) return joints.status();
  return std::make_unique<live::JsonLinesSource>(
      environment.in_descriptor,
      live::JsonLinesOptions{skeleton, *std::move(joints), arguments.realtime});
}

std::unique_ptr<live::FollowerSink> OpenSink(const std::string& to, const LiveArguments& arguments,
                                             const SynthesisRequest& request,
                                             const motion::Skeleton& skeleton,
                                             const ProgramEnvironment& environment) {
  if (to == kStandardStream) return std::make_unique<live::JsonLinesSink>(*environment.out);
  const bool plays_file = !arguments.leader.empty();
  return std::make_unique<LiveFileSink>(to, plays_file ? arguments.leader : "live", request,
                                        skeleton);
}

absl::StatusOr<live::LiveReport> RunSession(const LiveArguments& arguments,
                                            SynthesisRequest request, const Client& client,
                                            const motion::Skeleton& skeleton,
                                            Stopper<live::LeaderSource>* stopper,
                                            const ProgramEnvironment& environment) {
  const absl::StatusOr<std::unique_ptr<live::LeaderSource>> source =
      OpenSource(arguments, skeleton, environment, &request);
  if (!source.ok()) return source.status();
  std::vector<std::unique_ptr<live::FollowerSink>> sinks;
  std::vector<live::FollowerSink*> ends;
  for (const std::string& to : arguments.to) {
    sinks.push_back(OpenSink(to, arguments, request, skeleton, environment));
    ends.push_back(sinks.back().get());
  }
  std::function<void(const LiveNotice&)> on_notice;
  if (!arguments.quiet) {
    on_notice = [&environment](const LiveNotice& notice) { ShowNotice(notice, *environment.err); };
  }
  live::LiveRun run(source->get(), std::move(ends), std::move(on_notice));
  stopper->Set(source->get());
  absl::StatusOr<live::LiveReport> report = run.Run(client, ToLiveRequest(request, arguments));
  stopper->Set(nullptr);
  return report;
}

// What went wrong, in words; empty if nothing did.
std::string DescribeLosses(const LiveSummary& summary) {
  const struct {
    int count;
    const char *what, *became;
  } losses[] = {{summary.gap_frames, "missing leader frame", " interpolated"},
                {summary.late_frames, "late leader frame", " dropped"},
                {summary.skipped_frames, "follower frame",
                 " from an older plan, because the server could not keep up"}};
  std::vector<std::string> parts;
  for (const auto& [count, what, became] : losses) {
    if (count > 0) parts.push_back(absl::StrCat(base::Counted(count, what), became));
  }
  return absl::StrJoin(parts, "; ");
}

std::string DescribeLive(const live::LiveReport& report) {
  const LiveSummary& summary = report.summary;
  std::string text;
  for (const std::string& note : report.notes) absl::StrAppend(&text, "note      ", note, "\n");
  absl::StrAppend(&text, "model     ", report.info.model_name, "@", report.info.model_version,
                  ", seed ", report.info.seed, ", delay ",
                  base::Counted(report.info.delay_frames, "frame"), "\n");
  absl::StrAppendFormat(&text, "live      %.1f s, %d follower frames at %g Hz\n",
                        absl::ToDoubleSeconds(report.time), summary.follower_frames,
                        report.frame_rate_hz);
  const std::string losses = DescribeLosses(summary);
  if (!losses.empty()) absl::StrAppend(&text, "losses    ", losses, "\n");
  if (summary.resumed > 0) {
    absl::StrAppend(&text, "resumed   ", base::Counted(summary.resumed, "time"),
                    ", without losing a frame\n");
  }
  for (const std::string& line : report.written) absl::StrAppend(&text, "wrote     ", line, "\n");
  return text;
}

absl::Status RunLive(const LiveArguments& arguments, const ProgramEnvironment& environment) {
  Stopper<live::LeaderSource> stopper;
  const StopSignals signals([&stopper] { stopper.Stop(); });
  absl::StatusOr<PreparedCall> call =
      PrepareCall(arguments, arguments.server, CheckLiveFields, environment);
  if (!call.ok()) return call.status();
  const absl::StatusOr<live::LiveReport> report = RunSession(
      arguments, std::move(call->request), call->client, call->skeleton, &stopper, environment);
  if (!report.ok()) return report.status();
  if (arguments.quiet) return absl::OkStatus();
  // With frames on standard output, the summary goes to standard error.
  const bool out_has_frames = CountOf(kStandardStream, arguments.to) > 0;
  (out_has_frames ? *environment.err : *environment.out) << DescribeLive(*report);
  return absl::OkStatus();
}

// Checks a value of --to before any work is done: it may not replace a file that is read.
absl::Status CheckSink(const std::string& to, const LiveArguments& arguments) {
  if (formats::FormatOf(to) == formats::Format::kSbuText) {
    return absl::InvalidArgumentError(
        absl::StrCat(to, ": expected a format that can hold one person, got SBU text"));
  }
  if (to == kStandardStream) return absl::OkStatus();
  return CheckOutput(to, {arguments.leader, arguments.follower_start, arguments.request});
}

// Checks flags that depend on each other.
void CheckTogether(const LiveArguments& arguments) {
  if (arguments.weights.empty() && arguments.keyframes.empty() && arguments.request.empty()) {
    RejectMissing("--label, --keyframe or --request");
  }
  if (CountOf(kStandardStream, arguments.to) > 1) {
    RejectFlag("--to", "expected - once, got it twice");
  }
  for (const std::string& to : arguments.to) {
    const absl::Status status = CheckSink(to, arguments);
    if (!status.ok()) RejectFlag("--to", std::string(status.message()));
  }
}

constexpr char kFooter[] = R"(
Standard input (--from -) holds lines of JSON. The first one describes the frames, the others are
frames or change the labels:
  {"joints": ["head", ...], "rate": 30, "unit": "m", "up": "y"}
  {"positions": [[x, y, z], ...], "frame": 0, "t": 0.033}
  {"labels": {"hug": 1}, "ease": 0.3}
--to - writes {"joints": ...} and then {"frame": 0, "positions": ...} for each final frame.

Ctrl-C ends the leader's motion: the frames that are due arrive, and files are written. Another
Ctrl-C, more than a second later, ends the program at once.

Motion capture (VMC, Xsens MVN, Rokoko) has a bridge of its own: contrib/capture.

Example:
  duet live --from walk.bvh --realtime --label hug=1 --to follower.bvh --to pair.html
)";

void AddFlags(CLI::App* app, LiveArguments* arguments) {
  AddValue(app, kInputGroup, "--from", "FILE|-", &arguments->from,
           "Leader: a motion file that synthesize reads, or - for lines of JSON on standard "
           "input")
      ->required();
  app->add_flag("--realtime", arguments->realtime,
                "Play the file at its frame rate, and take standard input as it comes; otherwise "
                "each frame waits for the answer to the one before")
      ->group(kInputGroup);
  AddLeaderFlags(app, arguments);
  AddReactionFlags(app, arguments);
  AddValue(app, kReactionGroup, "--delay", "FRAMES", &arguments->delay_frames,
           "Leader frames that the server waits for before it answers a frame, from 0 to "
           "10; a few give a better reaction")
      ->check(base::InRange(0, 10))
      ->capture_default_str();
  AddValue(app, kOutputGroup, "--to", "FILE|-", &arguments->to,
           "Where the follower goes: a motion file with the follower as its only person, a "
           "page with both people (.html), or - for lines of JSON on standard output; "
           "repeatable")
      ->required()
      ->allow_extra_args(false);
  app->add_flag("--quiet", arguments->quiet, "Print only errors")->group(kOutputGroup);
  AddServerFlags(app, &arguments->server);
  app->footer(kFooter);
  app->callback([arguments] {
    if (arguments->from != kStandardStream) arguments->leader = arguments->from;
    CheckTogether(*arguments);
  });
}

}  // namespace

Command AddLiveCommand(CLI::App* program) {
  const auto arguments = std::make_shared<LiveArguments>();
  CLI::App* app = program->add_subcommand("live", "Answer a leader while it still moves");
  AddFlags(app, arguments.get());
  return MakeCommand(app, arguments, RunLive);
}

}  // namespace duet::client::cli
