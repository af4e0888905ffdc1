#include "client/cli/live_command.h"

#include <memory>
#include <mutex>
#include <optional>
#include <ostream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "client/cli/input_flags.h"
#include "client/cli/live_arguments.h"
#include "client/cli/live_ends.h"
#include "client/cli/live_flags.h"
#include "client/cli/live_report.h"
#include "client/cli/request_building.h"
#include "client/cli/server_options.h"
#include "client/cli/stop_signals.h"
#include "client/cli/typed_labels.h"
#include "client/live/live_run.h"
#include "client/model_skeleton.h"

namespace duet::client::cli {
namespace {

// Stops a source that may not exist yet.
class Stopper {
 public:
  void Stop() {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
    if (source_ != nullptr) source_->Stop();
  }
  void SetSource(live::LeaderSource* source) {
    const std::lock_guard<std::mutex> lock(mutex_);
    source_ = source;
    if (stopped_ && source_ != nullptr) source_->Stop();
  }

 private:
  std::mutex mutex_;
  live::LeaderSource* source_ = nullptr;
  bool stopped_ = false;
};

LiveStrip::Kind StripKind(const LiveArguments& arguments, const ProgramEnvironment& environment) {
  if (arguments.quiet) return LiveStrip::Kind::kNone;
  return environment.err_is_terminal ? LiveStrip::Kind::kTerminal : LiveStrip::Kind::kLinesOnly;
}

absl::StatusOr<live::LiveReport> RunSession(const LiveArguments& arguments, const Client& client,
                                            const motion::Skeleton& skeleton, Stopper* stopper,
                                            const ProgramEnvironment& environment) {
  LiveStrip strip(StripKind(arguments, environment), *environment.err);
  absl::StatusOr<LiveInput> input = OpenSource(
      arguments, skeleton, environment, [&strip](const std::string& note) { strip.Show(note); });
  if (!input.ok()) return input.status();
  std::vector<std::unique_ptr<live::FollowerSink>> sinks;
  std::vector<live::FollowerSink*> ends;
  for (const std::string& to : arguments.to) {
    absl::StatusOr<std::unique_ptr<live::FollowerSink>> sink =
        OpenSink(to, arguments, skeleton, environment);
    if (!sink.ok()) return sink.status();
    sinks.push_back(*std::move(sink));
    ends.push_back(sinks.back().get());
  }
  live::LiveRun run(input->source.get(), std::move(ends),
                    {[&strip](const live::LiveProgress& progress) { strip.Show(progress); },
                     [&strip](const LiveNotice& notice) { strip.Show(notice); }});
  stopper->SetSource(input->source.get());
  absl::StatusOr<live::LiveReport> report;
  {
    const TypedLabels typed(arguments, environment, &run);
    report = run.Run(client, input->request);
  }
  stopper->SetSource(nullptr);
  strip.End();
  return report;
}

absl::Status RunLive(const LiveArguments& arguments, const ProgramEnvironment& environment) {
  Stopper stopper;
  const StopSignals signals([&stopper] { stopper.Stop(); });
  if (!arguments.leader.empty()) {
    absl::Status inputs = CheckInputs(arguments);
    if (!inputs.ok()) return inputs;
  }
  const absl::StatusOr<Client> client = Connect(arguments.server, environment);
  if (!client.ok()) return client.status();
  const absl::StatusOr<ModelDetails> details = client->GetModel(arguments.model);
  if (!details.ok()) return details.status();
  const absl::Status labels = CheckLabels(arguments, details->model);
  if (!labels.ok()) return labels;
  const absl::StatusOr<motion::Skeleton> skeleton = ToSkeleton(details->model);
  if (!skeleton.ok()) return skeleton.status();
  const absl::StatusOr<live::LiveReport> report =
      RunSession(arguments, *client, *skeleton, &stopper, environment);
  if (!report.ok()) return report.status();
  if (arguments.quiet) return absl::OkStatus();
  // With frames on standard output, the summary goes to standard error.
  const bool out_has_frames = WritesToStandardOutput({arguments.to.begin(), arguments.to.end()});
  (out_has_frames ? *environment.err : *environment.out)
      << (arguments.json ? LiveJson(*report) : DescribeLive(*report));
  return absl::OkStatus();
}

constexpr char kFooter[] = R"(
Standard input (--from -) holds lines of JSON. The first one describes the frames, the others are
frames or change the labels:
  {"joints": ["head", ...], "rate": 30, "unit": "m", "up": "y"}
  {"positions": [[x, y, z], ...], "frame": 0, "t": 0.033}
  {"labels": {"hug": 1}, "ease": 0.3}
--to - writes {"joints": ...} and then {"frame": 0, "positions": ...} for each final frame.

While a file plays, labels can be typed: hug=1 kick=0 ease=0.3, then Enter. Ctrl-C ends
the leader's motion: the frames that are due arrive, and files are written. Another Ctrl-C, more than
a second later, ends the program at once.

Motion capture (VMC, Xsens MVN, Rokoko) has a bridge of its own: contrib/capture.

Example:
  duet live --from walk.bvh --realtime --label hug=1 --to follower.bvh --to pair.html
)";

}  // namespace

Command AddLiveCommand(FlagSet* program) {
  const auto arguments = std::make_shared<LiveArguments>();
  FlagSet* app = program->AddCommand("live", "Answer a leader while it still moves");
  AddLiveFlags(app, arguments.get());
  app->Footer(kFooter);
  return MakeServerCommand(app, arguments, RunLive);
}

}  // namespace duet::client::cli
