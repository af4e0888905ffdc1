#include "client/cli/synthesize_flags.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"
#include "client/cli/flags.h"
#include "client/cli/input_flags.h"
#include "client/cli/output.h"
#include "client/cli/reaction_flags.h"
#include "client/cli/rig_flags.h"
#include "client/cli/server_flags.h"
#include "client/cli/value_syntax.h"
#include "model/formats/follower_rig.h"
#include "model/formats/motion_file.h"

namespace duet::client::cli {
namespace {

const std::map<std::string, Priority> kPriorities = {{"interactive", Priority::kInteractive},
                                                     {"bulk", Priority::kBulk}};

void AddLeaderFlags(FlagSet* app, SynthesizeArguments* arguments) {
  app->Add("--leader", &arguments->leader,
           absl::StrCat("Motion of the leader: ", formats::kReadableExtensions,
                        "; - for standard input"))
      ->Required()
      ->Form("FILE")
      ->Group(kInputGroup);
  AddReadingFlags(app, arguments);
}

void AddReactionFlags(FlagSet* app, SynthesizeArguments* arguments) {
  Flag* label = AddLabelFlag(app, arguments);
  AddParsed<KeyframeArgument>(
      app, "--keyframe", "FRAME|BEATSb:CLASS[=WEIGHT],...", ParseKeyframe,
      AppendTo(&arguments->keyframes),
      "Weights from a frame on, for weights that change over time; with --beat also from a "
      "position in beats, where 0b is the first beat; repeatable")
      ->Excludes(label)
      ->Group(kReactionGroup);
  AddParsed<motion::Beat>(
      app, "--beat", "BPM[,OFFSET]", ParseBeat,
      [arguments](motion::Beat beat) { arguments->beat = beat; },
      "Beat of the music, from 20 to 400 a minute, with the time of the first beat in seconds "
      "(default: 0): reports how far steps are from it, and adds a metronome to .html")
      ->LastOnly()
      ->Group(kReactionGroup);
  AddModelFlag(app, arguments);
  AddStartFlags(app, arguments);
  AddSamplingFlags(app, arguments);
  app->Add("--samples", &arguments->samples,
           "Number of answers, with the seeds SEED, SEED+1, ...; with several, each --out "
           "pair.html becomes pair.seed0.html and so on")
      ->InRange(1, 1000)
      ->ShowDefault()
      ->Form("COUNT")
      ->Group(kReactionGroup);
  AddCleanUpFlag(app, arguments);
  AddParsed<JointConstraint>(
      app, "--pin", "JOINT@FRAME=X,Y,Z[,SOFTNESS]", ParsePin, AppendTo(&arguments->constraints),
      "Where a joint of the model must be in a frame, in metres, y up, such as "
      "right_hand@40=0.2,1.3,0.5; a softness up to 1 lets that share of the distance remain; "
      "repeatable")
      ->Group(kReactionGroup);
  app->AddSwitch("--rotations", &arguments->rotations,
                 "Write the follower's joint rotations beside its positions to .json, for engines")
      ->Group(kReactionGroup);
  AddChoice<Priority>(
      app, "--priority", kPriorities,
      [arguments](Priority priority) { arguments->priority = priority; },
      "bulk calls yield to interactive calls, and wait if the server is full")
      ->ShowDefault(NameOf(kPriorities, arguments->priority))
      ->Group(kReactionGroup);
  app->Add("--chunk-frames", &arguments->chunk_frames, "Frames in each chunk of the reply")
      ->InRange(1, 100000)
      ->Form("FRAMES")
      ->Group(kReactionGroup);
  AddRequestIdFlag(app, arguments);
}

// "a.bvh --out b.json"
std::string OutputsText(const std::vector<std::filesystem::path>& outputs) {
  return absl::StrJoin(outputs, " --out ", [](std::string* out, const std::filesystem::path& path) {
    out->append(path.string());
  });
}

// Returns the flags that specify how the follower's rig is read.
std::vector<Flag*> AddOutputFlags(FlagSet* app, SynthesizeArguments* arguments) {
  app->Add(
         "--out", &arguments->outputs,
         "File to write: .html (a page to watch), .glb or .gltf (both people, for Blender "
         "and engines), .bvh (two files), .csv, .npy, .json or .txt (SBU text); repeatable; - for "
         "standard output")
      ->Required()
      ->OneValueEach()
      ->Form("FILE")
      ->Group(kOutputGroup);
  AddOutputFormatFlag(app, &arguments->output_format);
  AddBvhFlags(app, &arguments->bvh);
  app->Add(
         "--follower-rig", &arguments->follower_rig,
         "Rig of the follower in --out FILE.bvh, FILE.glb and FILE.gltf: the leader's rig, or the "
         "rig of another .bvh, .glb or .gltf (default: Duet's rig)")
      ->Form("leader|FILE")
      ->Group(kOutputGroup);
  std::vector<Flag*> rig_flags =
      AddRigReadingFlags(app, "--follower-rig", "--follower-rig FILE", &arguments->rig);
  app->AddSwitch("--json", &arguments->json, "Print the summary as JSON")->Group(kOutputGroup);
  app->AddSwitch("--quiet", &arguments->quiet, "Print only errors")->Group(kOutputGroup);
  return rig_flags;
}

// "--joint-map" of "--follower-rig-joint-map"
std::string LeadersFlag(const Flag& rig_flag) {
  return absl::StrCat("-", absl::StripPrefix(rig_flag.name(), "--follower-rig"));
}

void CheckFollowerRig(const SynthesizeArguments& arguments, const std::vector<Flag*>& rig_flags) {
  const bool leaders = arguments.follower_rig == kLeadersRig;
  for (const Flag* flag : rig_flags) {
    if (!flag->is_typed() || (!leaders && !arguments.follower_rig.empty())) continue;
    RejectFlag(flag->name(),
               absl::StrCat("is only valid with --follower-rig FILE. For the leader's rig, use ",
                            LeadersFlag(*flag)));
  }
  if (arguments.follower_rig.empty()) return;
  const std::filesystem::path file =
      leaders ? arguments.leader : std::filesystem::path(arguments.follower_rig);
  const std::optional<formats::Format> rig = formats::FormatOf(file);
  const bool fits = rig && std::any_of(arguments.outputs.begin(), arguments.outputs.end(),
                                       [rig](const std::filesystem::path& output) {
                                         const auto written = formats::FormatOf(output);
                                         return written && formats::FitsRig(*written, *rig);
                                       });
  if (fits) return;
  RejectFlag("--follower-rig", absl::StrCat("expected ", formats::kRigExtensions,
                                            " and --out FILE in its format, got ", file.string(),
                                            " and --out ", OutputsText(arguments.outputs)));
}

bool Writes(formats::Format format, const SynthesizeArguments& arguments) {
  return WritesFormat(format, arguments.outputs, arguments.output_format);
}

void CheckRotations(const SynthesizeArguments& arguments) {
  if (!arguments.rotations || Writes(formats::Format::kJson, arguments)) return;
  RejectFlag("--rotations", absl::StrCat("expected --out FILE.json, which holds them, got --out ",
                                         OutputsText(arguments.outputs)));
}

void CheckKeyframes(const SynthesizeArguments& arguments) {
  if (arguments.beat) return;
  for (const KeyframeArgument& keyframe : arguments.keyframes) {
    if (!keyframe.beats) continue;
    RejectFlag("--keyframe", absl::StrCat("expected --beat BPM[,OFFSET] with the position ",
                                          *keyframe.beats, "b in beats, got no --beat"));
  }
}

// A pair in a format with one file for each person has other files than its output.
void CheckOutputs(const SynthesizeArguments& arguments) {
  const std::vector<std::filesystem::path> inputs = {arguments.leader, arguments.follower_start,
                                                     arguments.follower_rig};
  for (int sample = 0; sample < arguments.samples; ++sample) {
    for (const std::filesystem::path& output : SampleOutputs(arguments, sample)) {
      absl::Status status = CheckOutput(output, inputs);
      for (const std::filesystem::path& file : PairFiles(output, !arguments.follower_rig.empty())) {
        status.Update(CheckReplacesNone(file, inputs));
      }
      if (!status.ok()) RejectFlag("--out", std::string(status.message()));
    }
  }
}

// Checks flags that depend on each other.
void CheckTogether(const FlagSet& command, const SynthesizeArguments& arguments,
                   const std::vector<Flag*>& rig_flags) {
  if (arguments.weights.empty() && arguments.keyframes.empty()) {
    RejectMissing("--label or --keyframe");
  }
  CheckStandardOutput(arguments.outputs, arguments.output_format, arguments.json);
  CheckFollowerRig(arguments, rig_flags);
  CheckBvhFlags(command, arguments.outputs, arguments.output_format);
  CheckRotations(arguments);
  CheckKeyframes(arguments);
  if (arguments.samples > 1 && WritesToStandardOutput(arguments.outputs)) {
    RejectFlag("--samples", "cannot be used with --out -: each answer needs a file");
  }
  if (arguments.output_format && arguments.output_format->motion == formats::Format::kBvh) {
    RejectFlag("--output-format",
               "bvh cannot be used with --out -: it has one file for each person");
  }
  const uint64_t left = std::numeric_limits<uint64_t>::max() - arguments.seed;
  if (static_cast<uint64_t>(arguments.samples) - 1 > left) {
    RejectFlag("--samples",
               absl::StrCat("expected at most ", left + 1, " with --seed ", arguments.seed,
                            ", so that no seed exceeds the largest, got ", arguments.samples));
  }
  CheckOutputs(arguments);
}

}  // namespace

void AddSynthesizeFlags(FlagSet* command, SynthesizeArguments* arguments) {
  AddLeaderFlags(command, arguments);
  AddReactionFlags(command, arguments);
  const std::vector<Flag*> rig_flags = AddOutputFlags(command, arguments);
  AddServerFlags(command, &arguments->server);
  command->Check(
      [command, arguments, rig_flags] { CheckTogether(*command, *arguments, rig_flags); });
}

}  // namespace duet::client::cli
