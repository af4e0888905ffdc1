#include "client/cli/arguments.h"

#include <limits>
#include <map>
#include <sstream>
#include <utility>

#include "CLI/CLI.hpp"
#include "absl/strings/str_cat.h"
#include "client/cli/batch_flags.h"
#include "client/cli/exit_code.h"
#include "client/cli/flags.h"
#include "client/cli/output.h"
#include "client/cli/server_flags.h"
#include "client/cli/value_syntax.h"

namespace duet::client::cli {
namespace {

constexpr char kExitCodes[] = R"(
Exit codes:
  0   done
  1   failed, but the same call may succeed later (server away, busy or draining)
  2   the command line makes no sense
  42  failed, and will again: the input, the model or the credentials are refused

Example:
  duet synthesize --leader kick.bvh --label kick=1 --out pair.html --out pair.bvh
)";

const std::map<std::string, formats::Side> kSides = {{"left", formats::Side::kLeft},
                                                     {"right", formats::Side::kRight}};
const std::map<std::string, Priority> kPriorities = {{"interactive", Priority::kInteractive},
                                                     {"bulk", Priority::kBulk}};

// "auto" leaves the choice to the server.
const std::map<std::string, std::optional<bool>> kCleanUps = {
    {"auto", std::nullopt}, {"on", true}, {"off", false}};

void AddInputFlags(CLI::App* app, SynthesizeArguments* arguments) {
  constexpr char kGroup[] = "Input";
  app->add_option("--leader", arguments->leader,
                  "Motion of the leader: .bvh, .gltf, .glb, .amc, .csv, .npy, .json or SBU .txt")
      ->required()
      ->type_name("FILE")
      ->group(kGroup);
  AddChoice<formats::Side>(
      app, "--leader-side", kSides,
      [arguments](formats::Side side) { arguments->leader_side = side; },
      "Which person of a file with two leads")
      ->default_str(NameOf(kSides, arguments->leader_side))
      ->group(kGroup);
  InputArguments* input = &arguments->input;
  app->add_option("--frame-rate", input->frame_rate_hz, "Replaces what the file says")
      ->check(Undescribed(CLI::PositiveNumber))
      ->type_name("HZ")
      ->group(kGroup);
  AddParsed<motion::LengthUnit>(
      app, "--unit", "metres|millimetres|sbu-normalised", ParseUnit,
      [input](motion::LengthUnit unit) { input->unit = unit; },
      "Unit of positions; replaces what the file says")
      ->take_last()
      ->group(kGroup);
  AddParsed<motion::UpAxis>(
      app, "--up-axis", "y-up|z-up|y-down", ParseAxis,
      [input](motion::UpAxis axis) { input->up_axis = axis; },
      "Up axis of positions; replaces what the file says")
      ->take_last()
      ->group(kGroup);
  app->add_option("--metres-per-unit", input->metres_per_unit,
                  "BVH, glTF, ASF: metres in one unit of the file (0.01 for centimetres)")
      ->check(Undescribed(CLI::PositiveNumber))
      ->type_name("METRES")
      ->group(kGroup);
  AddParsed<std::pair<std::string, std::string>>(
      app, "--joint-map", "MODEL_JOINT=FILE_JOINT", ParseJointPair,
      [input](std::pair<std::string, std::string> joints) { input->joints.insert(joints); },
      "Where names alone do not tell which is which; repeatable")
      ->group(kGroup);
  app->add_option("--joint-map-file", input->joint_table,
                  "A table of such joints, one MODEL_JOINT=FILE_JOINT a line; --joint-map wins")
      ->type_name("FILE")
      ->group(kGroup);
}

void AddSamplingFlags(CLI::App* app, SynthesizeArguments* arguments) {
  constexpr char kGroup[] = "Reaction";
  AddParsed<uint64_t>(
      app, "--seed", "SEED", ParseSeed, [arguments](uint64_t seed) { arguments->seed = seed; },
      "Which answer of a model that samples; the same seed gives the same answer")
      ->take_last()
      ->default_str(absl::StrCat(arguments->seed))
      ->group(kGroup);
  AddParsed<float>(
      app, "--variety", "VARIETY", ParseVariety,
      [arguments](float variety) { arguments->variety = variety; },
      "How varied such answers are: 0 the typical one, 1 as varied as people, up to 2")
      ->take_last()
      ->default_str(absl::StrCat(arguments->variety))
      ->group(kGroup);
  app->add_option("--samples", arguments->samples,
                  "Answers to ask for, with seeds SEED, SEED+1, ...; with several, each --out "
                  "pair.html becomes pair.seed0.html and so on")
      ->check(Undescribed(CLI::Range(1, 1000)))
      ->capture_default_str()
      ->type_name("COUNT")
      ->group(kGroup);
}

void AddReactionFlags(CLI::App* app, SynthesizeArguments* arguments) {
  constexpr char kGroup[] = "Reaction";
  CLI::Option* label = AddParsed<ClassWeight>(app, "--label", "CLASS=WEIGHT", ParseClassWeight,
                                              AppendTo(&arguments->weights),
                                              "Such as kick=1 or hug=-0.5; repeatable")
                           ->group(kGroup);
  AddParsed<WeightKeyframe>(app, "--keyframe", "FRAME:CLASS=WEIGHT,...", ParseKeyframe,
                            AppendTo(&arguments->keyframes),
                            "For weights that change over time; repeatable")
      ->excludes(label)
      ->group(kGroup);
  AddParsed<ModelChoice>(
      app, "--model", "NAME[@VERSION|:LABEL]", ParseModelChoice,
      [arguments](ModelChoice choice) { arguments->model = std::move(choice); },
      "Default: the server's own")
      ->take_last()
      ->group(kGroup);
  app->add_option("--follower-start", arguments->follower_start,
                  "Where the follower begins: a motion file (its first frame), or X,Y,Z of the "
                  "root joint in metres, y up")
      ->type_name("FILE|X,Y,Z")
      ->group(kGroup);
  AddChoice<formats::Side>(
      app, "--follower-start-side", kSides,
      [arguments](formats::Side side) { arguments->follower_start_side = side; },
      absl::StrCat("Which person of a file with two (default: not the leader where it is the "
                   "leader's file, else ",
                   NameOf(kSides, kDefaultSide), ")"))
      ->group(kGroup);
  AddParsed<motion::Vec3>(
      app, "--partner-direction", "X,Y,Z", ParseDirection,
      [arguments](motion::Vec3 direction) { arguments->partner_direction = direction; },
      "Where the follower should be, as a horizontal direction from the leader (default: towards "
      "--follower-start, else as the model tells from the leader)")
      ->take_last()
      ->group(kGroup);
  AddSamplingFlags(app, arguments);
  AddChoice<std::optional<bool>>(
      app, "--clean-up", kCleanUps,
      [arguments](std::optional<bool> clean_up) { arguments->clean_up = clean_up; },
      "Correct the follower: stand, feet still, human joints, out of the leader; auto: as the "
      "server does for the model")
      ->default_str(NameOf(kCleanUps, arguments->clean_up))
      ->group(kGroup);
  AddChoice<Priority>(
      app, "--priority", kPriorities,
      [arguments](Priority priority) { arguments->priority = priority; },
      "bulk yields to interactive calls and waits when the server is full")
      ->default_str(NameOf(kPriorities, arguments->priority))
      ->group(kGroup);
  app->add_option("--chunk-frames", arguments->chunk_frames, "Frames in one chunk of the reply")
      ->check(Undescribed(CLI::Range(1, 100000)))
      ->type_name("FRAMES")
      ->group(kGroup);
  app->add_option("--request-id", arguments->request_id, "Names the call in the server's log")
      ->type_name("ID")
      ->group(kGroup);
}

void AddOutputFlags(CLI::App* app, SynthesizeArguments* arguments) {
  constexpr char kGroup[] = "Output";
  app->add_option("--out", arguments->outputs,
                  "File to write: .html (a page to watch), .bvh (two files), .csv, .npy or .json; "
                  "repeatable")
      ->required()
      ->allow_extra_args(false)
      ->type_name("FILE")
      ->group(kGroup);
  app->add_flag("--json", arguments->json, "Print the summary as JSON")->group(kGroup);
  app->add_flag("--quiet", arguments->quiet, "Print errors alone")->group(kGroup);
}

// What no single flag can tell.
void CheckTogether(const SynthesizeArguments& arguments) {
  if (arguments.weights.empty() && arguments.keyframes.empty()) {
    throw CLI::RequiredError("--label or --keyframe");
  }
  const uint64_t left = std::numeric_limits<uint64_t>::max() - arguments.seed;
  if (static_cast<uint64_t>(arguments.samples) - 1 > left) {
    throw CLI::ValidationError(
        "--samples", absl::StrCat(arguments.samples, " from --seed ", arguments.seed,
                                  " on pass the largest seed, wanted at most ", left + 1));
  }
  for (int sample = 0; sample < arguments.samples; ++sample) {
    for (const std::filesystem::path& output : SampleOutputs(arguments, sample)) {
      const absl::Status status = CheckOutput(output, arguments.leader);
      if (!status.ok()) throw CLI::ValidationError("--out", std::string(status.message()));
    }
  }
}

}  // namespace

std::vector<std::filesystem::path> SampleOutputs(const SynthesizeArguments& arguments, int sample) {
  std::vector<std::filesystem::path> outputs = arguments.outputs;
  if (arguments.samples == 1) return outputs;
  for (std::filesystem::path& output : outputs) {
    if (!output.has_extension()) continue;  // is refused under the name that it came with
    output.replace_filename(absl::StrCat(output.stem().string(), ".seed", SeedOf(arguments, sample),
                                         output.extension().string()));
  }
  return outputs;
}

ParsedCommandLine ParseCommandLine(const std::vector<std::string>& arguments) {
  CLI::App app("Asks a Duet server to answer one character's motion with another's.", "duet");
  app.set_version_flag("--version", "duet " DUET_VERSION);
  app.require_subcommand(1);
  app.footer(kExitCodes);
  app.get_formatter()->column_width(34);

  ModelsArguments models;
  CLI::App* models_command = app.add_subcommand("models", "List the models being served");
  AddServerFlags(models_command, &models.server);
  models_command->add_flag("--json", models.json, "Print JSON");

  SynthesizeArguments synthesize;
  CLI::App* synthesize_command =
      app.add_subcommand("synthesize", "Synthesise the follower of a leader");
  AddInputFlags(synthesize_command, &synthesize);
  AddReactionFlags(synthesize_command, &synthesize);
  AddOutputFlags(synthesize_command, &synthesize);
  AddServerFlags(synthesize_command, &synthesize.server);
  synthesize_command->footer(kExitCodes);
  synthesize_command->callback([&synthesize] { CheckTogether(synthesize); });

  BatchArguments batch;
  const CLI::App* batch_command = AddBatchCommand(&app, &batch);

  ParsedCommandLine parsed;
  try {
    // CLI11 takes the arguments in reverse.
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError& error) {
    std::ostringstream out;
    const int code = app.exit(error, out, out);
    parsed.text = out.str();
    parsed.exit_code = code == 0 ? kExitDone : kExitUsage;
    return parsed;
  }
  if (models_command->parsed()) parsed.models = std::move(models);
  if (synthesize_command->parsed()) parsed.synthesize = std::move(synthesize);
  if (batch_command->parsed()) parsed.batch = std::move(batch);
  return parsed;
}

}  // namespace duet::client::cli
