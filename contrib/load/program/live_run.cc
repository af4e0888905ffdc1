#include "contrib/load/program/live_run.h"

#include <algorithm>
#include <memory>
#include <ostream>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "client/model_skeleton.h"
#include "contrib/load/grpc_live_target.h"
#include "contrib/load/live_generator.h"
#include "model/formats/motion_file.h"
#include "model/motion/resample.h"

namespace duet::contrib::load::program {
namespace {

constexpr double kLowestRate = 1, kHighestRate = 240;  // of a leader
constexpr double kMostIntervals = 300;                 // of a timeline
constexpr int kGeneratedFrames = 300;
constexpr absl::Duration kEnding = absl::Seconds(30);

absl::Status CheckFlags(const LoadArguments& arguments) {
  if (arguments.rates.size() > 1) {
    return absl::InvalidArgumentError(
        absl::StrCat("--rate: expected one rate with --live, got ", arguments.rates.size()));
  }
  const double rate = arguments.LiveRate();
  if (rate < kLowestRate || rate > kHighestRate) {
    return absl::InvalidArgumentError(absl::StrCat("--rate: expected ", kLowestRate, " to ",
                                                   kHighestRate, " with --live, got ", rate));
  }
  if (arguments.mix.models.size() > 1) {
    return absl::InvalidArgumentError(
        absl::StrCat("--model: expected one model with --live, got ", arguments.mix.models.size()));
  }
  return absl::OkStatus();
}

// The leaders in the model's joints, at a rate.
absl::StatusOr<std::vector<motion::Poses>> ReadLeaders(
    const std::vector<std::filesystem::path>& files, const client::ModelInfo& model, double rate) {
  std::vector<motion::Poses> leaders;
  if (files.empty()) {
    leaders.push_back(SwayingLeader(model, kGeneratedFrames).poses);
    return leaders;
  }
  const absl::StatusOr<motion::Skeleton> skeleton = client::ToSkeleton(model);
  if (!skeleton.ok()) return skeleton.status();
  formats::ReadOptions options;
  options.skeleton = *skeleton;
  for (const std::filesystem::path& file : files) {
    const absl::StatusOr<motion::Clip> clip = formats::ReadLeader(file, options);
    if (!clip.ok()) return clip.status();
    leaders.push_back(motion::Resample(clip->poses, clip->frame_rate_hz, rate));
  }
  return leaders;
}

LiveOptions OptionsOf(const LoadArguments& arguments, const LoadEnvironment& environment) {
  LiveOptions options;
  options.frame_rate_hz = arguments.LiveRate();
  options.in_step = arguments.in_step;
  options.conditions = arguments.live_conditions;
  options.seed = arguments.seed;
  options.warm_up = Seconds(arguments.warm_up_seconds);
  options.measured = Seconds(arguments.seconds);
  options.interval = Seconds(std::max(1.0, arguments.seconds / kMostIntervals));
  options.stopped = environment.stopped;
  return options;
}

}  // namespace

absl::StatusOr<LiveReport> RunLiveSteps(const LoadArguments& arguments,
                                        const LoadEnvironment& environment) {
  if (absl::Status status = CheckFlags(arguments); !status.ok()) return status;
  const absl::StatusOr<client::ClientOptions> server = ToClientOptions(arguments.server);
  if (!server.ok()) return server.status();
  const absl::StatusOr<client::Client> client = client::Client::Create(*server);
  if (!client.ok()) return client.status();
  LiveContent content = arguments.live_content;
  content.model = arguments.mix.models.front().value;
  content.labels = arguments.mix.labels;
  const absl::StatusOr<client::ModelDetails> details = client->GetModel(content.model);
  if (!details.ok()) return details.status();
  LiveOptions options = OptionsOf(arguments, environment);
  absl::StatusOr<std::vector<motion::Poses>> leaders =
      ReadLeaders(arguments.leaders, details->model, options.frame_rate_hz);
  if (!leaders.ok()) return leaders.status();
  const absl::Duration longest =
      absl::Seconds(arguments.warm_up_seconds + arguments.seconds) + kEnding;
  const absl::StatusOr<std::unique_ptr<LiveTarget>> target = ConnectLiveTarget(
      *server, arguments.connections,
      {content, details->model, options.frame_rate_hz, *std::move(leaders), longest});
  if (!target.ok()) return target.status();
  LiveReport report;
  report.model = absl::StrCat(details->model.name, "@", details->model.version);
  report.delay_frames = content.delay_frames;
  for (const int sessions : arguments.live) {
    if (environment.stopped()) break;
    options.sessions = sessions;
    if (!arguments.quiet) {
      *environment.err << "duet-load: " << sessions << " live sessions" << std::endl;
    }
    const double now = absl::ToDoubleSeconds(absl::Now() - absl::UnixEpoch());
    report.steps.push_back(RunLive(options, **target));
    report.steps.back().began_unix = now + arguments.warm_up_seconds;
  }
  return report;
}

}  // namespace duet::contrib::load::program
