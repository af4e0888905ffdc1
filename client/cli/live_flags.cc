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

void AddSourceFlags(CLI::App* app, LiveArguments* arguments) {
  app->add_option("--from", arguments->from,
                  "Leader: a motion file that synthesize reads, - for lines of JSON on standard "
                  "input, or motion capture over UDP: vmc://, xsens:// or rokoko://, with "
                  "[HOST][:PORT]")
      ->required()
      ->type_name("FILE|-|ADDRESS")
      ->group(kInputGroup);
  app->add_flag("--realtime", arguments->realtime,
                "Play the file at its frame rate, and take standard input as it comes; otherwise "
                "each frame waits for the answer to the one before")
      ->group(kInputGroup);
  AddReadingFlags(app, arguments);
}

void AddReactionFlags(CLI::App* app, LiveArguments* arguments) {
  CLI::Option* label = AddLabelFlag(app, arguments);
  AddParsed<KeyframeArgument>(app, "--keyframe", "FRAME:CLASS[=WEIGHT],...", ParseKeyframe,
                              AppendTo(&arguments->keyframes),
                              "Weights from a frame on, for weights that change over time; "
                              "repeatable")
      ->excludes(label)
      ->group(kReactionGroup);
  AddModelFlag(app, arguments);
  AddStartFlags(app, arguments);
  AddSamplingFlags(app, arguments);
  AddCleanUpFlag(app, arguments);
  app->add_option("--delay", arguments->delay_frames,
                  "Leader frames that the server waits for before it answers a frame, from 0 to "
                  "10; a few give a better reaction")
      ->check(Undescribed(CLI::Range(0, 10)))
      ->capture_default_str()
      ->type_name("FRAMES")
      ->group(kReactionGroup);
  app->add_option("--plan", arguments->plan_frames,
                  "Provisional frames, from 0 to 30, beyond each final one, for outputs that can "
                  "show them")
      ->check(Undescribed(CLI::Range(0, 30)))
      ->capture_default_str()
      ->type_name("FRAMES")
      ->group(kReactionGroup);
  AddRequestIdFlag(app, arguments);
}

void AddSinkFlags(CLI::App* app, LiveArguments* arguments) {
  app->add_option("--to", arguments->to,
                  "Where the follower goes: a motion file (.bvh, .glb, .gltf, .usda, .csv, .npy or "
                  ".json), a page with both people (.html), - for lines of JSON on standard "
                  "output, or vmc://HOST[:PORT] for game engines and Blender; repeatable")
      ->required()
      ->allow_extra_args(false)
      ->type_name("FILE|-|ADDRESS")
      ->group(kOutputGroup);
  AddBvhFlags(app, &arguments->bvh);
  app->add_flag("--json", arguments->json, "Print the summary as JSON")->group(kOutputGroup);
  app->add_flag("--quiet", arguments->quiet, "Print only errors")->group(kOutputGroup);
}

// Checks flags that depend on each other.
void CheckTogether(const LiveArguments& arguments) {
  if (arguments.weights.empty() && arguments.keyframes.empty()) {
    throw CLI::RequiredError("--label or --keyframe");
  }
  for (const KeyframeArgument& keyframe : arguments.keyframes) {
    if (!keyframe.beats) continue;
    throw CLI::ValidationError("--keyframe", absl::StrCat("expected a frame, got the position ",
                                                          *keyframe.beats, "b in beats"));
  }
  if (const absl::Status status = CheckSource(arguments.from); !status.ok()) {
    throw CLI::ValidationError("--from", std::string(status.message()));
  }
  const auto outs = std::count(arguments.to.begin(), arguments.to.end(), kStandardStream);
  if (outs > 1) throw CLI::ValidationError("--to", "expected - once, got it twice");
  if (outs > 0 && arguments.json) {
    throw CLI::ValidationError("--json",
                               "cannot be used with --to -: both print to standard output");
  }
  for (const std::string& to : arguments.to) {
    const absl::Status status = CheckSink(to, arguments.from);
    if (!status.ok()) throw CLI::ValidationError("--to", std::string(status.message()));
  }
}

}  // namespace

void AddLiveFlags(CLI::App* command, LiveArguments* arguments) {
  AddSourceFlags(command, arguments);
  AddReactionFlags(command, arguments);
  AddSinkFlags(command, arguments);
  AddServerFlags(command, &arguments->server);
  command->callback([arguments] {
    if (IsFile(arguments->from)) arguments->leader = arguments->from;
    CheckTogether(*arguments);
  });
}

}  // namespace duet::client::cli
