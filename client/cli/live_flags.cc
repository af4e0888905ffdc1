#include "client/cli/live_flags.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "client/cli/flags.h"
#include "client/cli/input_flags.h"
#include "client/cli/live_ends.h"
#include "client/cli/reaction_flags.h"
#include "client/cli/server_flags.h"
#include "client/cli/value_syntax.h"

namespace duet::client::cli {
namespace {

void AddSourceFlags(FlagSet* app, LiveArguments* arguments) {
  app->Add("--from", &arguments->from,
           "Leader: a motion file that synthesize reads, or - for lines of JSON on standard input")
      ->Required()
      ->Form("FILE|-")
      ->Group(kInputGroup);
  app->AddSwitch("--realtime", &arguments->realtime,
                 "Play the file at its frame rate, and take standard input as it comes; otherwise "
                 "each frame waits for the answer to the one before")
      ->Group(kInputGroup);
  AddReadingFlags(app, arguments);
}

void AddReactionFlags(FlagSet* app, LiveArguments* arguments) {
  Flag* label = AddLabelFlag(app, arguments);
  AddParsed<KeyframeArgument>(app, "--keyframe", "FRAME:CLASS[=WEIGHT],...", ParseKeyframe,
                              AppendTo(&arguments->keyframes),
                              "Weights from a frame on, for weights that change over time; "
                              "repeatable")
      ->Excludes(label)
      ->Group(kReactionGroup);
  AddModelFlag(app, arguments);
  AddStartFlags(app, arguments);
  AddSamplingFlags(app, arguments);
  AddCleanUpFlag(app, arguments);
  app->Add("--delay", &arguments->delay_frames,
           "Leader frames that the server waits for before it answers a frame, from 0 to "
           "10; a few give a better reaction")
      ->InRange(0, 10)
      ->ShowDefault()
      ->Form("FRAMES")
      ->Group(kReactionGroup);
  app->Add("--plan", &arguments->plan_frames,
           "Provisional frames, from 0 to 30, beyond each final one, for outputs that can "
           "show them")
      ->InRange(0, 30)
      ->ShowDefault()
      ->Form("FRAMES")
      ->Group(kReactionGroup);
  AddRequestIdFlag(app, arguments);
}

void AddSinkFlags(FlagSet* app, LiveArguments* arguments) {
  app->Add("--to", &arguments->to,
           "Where the follower goes: a motion file (.bvh, .glb, .gltf, .csv, .npy or "
           ".json), a page with both people (.html), or - for lines of JSON on standard output; "
           "repeatable. A file other than a page holds the follower alone, as the first person")
      ->Required()
      ->OneValueEach()
      ->Form("FILE|-")
      ->Group(kOutputGroup);
  AddBvhFlags(app, &arguments->bvh);
  app->AddSwitch("--json", &arguments->json, "Print the summary as JSON")->Group(kOutputGroup);
  app->AddSwitch("--quiet", &arguments->quiet, "Print only errors")->Group(kOutputGroup);
}

// Checks flags that depend on each other.
void CheckTogether(const FlagSet& command, const LiveArguments& arguments) {
  if (arguments.weights.empty() && arguments.keyframes.empty()) {
    RejectMissing("--label or --keyframe");
  }
  for (const KeyframeArgument& keyframe : arguments.keyframes) {
    if (!keyframe.beats) continue;
    RejectFlag("--keyframe",
               absl::StrCat("expected a frame, got the position ", *keyframe.beats, "b in beats"));
  }
  CheckBvhFlags(command, {arguments.to.begin(), arguments.to.end()}, std::nullopt);
  const auto outs = std::count(arguments.to.begin(), arguments.to.end(), kStandardStream);
  if (outs > 1) RejectFlag("--to", "expected - once, got it twice");
  if (outs > 0 && arguments.json) {
    RejectFlag("--json", "cannot be used with --to -: both print to standard output");
  }
  for (const std::string& to : arguments.to) {
    const absl::Status status = CheckSink(to, arguments);
    if (!status.ok()) RejectFlag("--to", std::string(status.message()));
  }
}

}  // namespace

void AddLiveFlags(FlagSet* command, LiveArguments* arguments) {
  AddSourceFlags(command, arguments);
  AddReactionFlags(command, arguments);
  AddSinkFlags(command, arguments);
  AddServerFlags(command, &arguments->server);
  command->Check([command, arguments] {
    if (IsFile(arguments->from)) arguments->leader = arguments->from;
    CheckTogether(*command, *arguments);
  });
}

}  // namespace duet::client::cli
