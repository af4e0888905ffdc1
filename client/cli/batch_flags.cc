#include "client/cli/batch_flags.h"

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "client/batch/level.h"
#include "client/cli/flags.h"
#include "client/cli/server_flags.h"

namespace duet::client::cli {
namespace {

using Action = BatchArguments::Action;

constexpr char kBatchFooter[] = R"(
To continue a run that stopped for any reason, run the same command again. docs/batch.md has a tour.

Exit codes:
  0   every item is settled: done, or rejected by the recipe's filter
  1   run it again: stopped, a server away, a full disk, items that failed temporarily
  2   the command line is invalid
  42  items failed permanently (failed.tsv), or the recipe, the input or the models are rejected

Example:
  duet batch walks/ --recipe mixes.textproto --out set
)";

constexpr char kVerifyFooter[] = R"(
The next run of the same duet batch command repairs the damage that was found. --repair runs the
command of the last run again, in the folder where that run was started.

Exit codes:
  0   every file is as it was written
  1   run it again: items are missing, or the repair was stopped
  42  files are missing or were changed, or the repair is rejected
)";

const std::map<std::string, batch::Packing> kPackings = {
    {"none", batch::Packing::kNone}, {"npz", batch::Packing::kNpz}, {"tar", batch::Packing::kTar}};

// Checks the text, which becomes part of the recipe.
absl::StatusOr<std::string> ParseLevelText(absl::string_view text) {
  const absl::StatusOr<batch::Level> level = batch::ParseLevel(text);
  if (!level.ok()) return level.status();
  return std::string(text);
}

void AddInputFlags(CLI::App* app, BatchArguments* arguments) {
  constexpr char kGroup[] = "Input";
  CLI::Option* leaders = app->add_option("leaders", arguments->leaders,
                                         "Motion files, folders of them, or patterns (walks/*.bvh)")
                             ->type_name("LEADER");
  app->add_option("--manifest", arguments->manifest,
                  "List of leaders, one on each line, as JSON objects or TSV; - for standard input")
      ->excludes(leaders)
      ->type_name("FILE")
      ->group(kGroup);
  app->add_option("--recipe", arguments->recipe,
                  "Reactions and outputs for each leader: text format, or JSON in a .json file")
      ->type_name("FILE")
      ->group(kGroup);
  app->add_option("--input-format", arguments->overrides.input_format,
                  "Format of every leader; overrides the extension and the recipe")
      ->check(Undescribed(CLI::IsMember(std::vector<std::string>{"amc", "bvh", "csv", "glb", "gltf",
                                                                 "json", "npy", "npz", "sbu"})))
      ->type_name("amc|bvh|csv|glb|gltf|json|npy|npz|sbu")
      ->group(kGroup);
  app->add_option("--layout", arguments->overrides.layout,
                  "Layout of .npy leaders of research; overrides the recipe")
      ->check(Undescribed(CLI::IsMember(std::vector<std::string>{
          "humanml3d", "humanml3d-263", "inter-x", "intergen", "intergen-262"})))
      ->type_name("humanml3d|humanml3d-263|inter-x|intergen|intergen-262")
      ->group(kGroup);
  app->add_option("--body-model", arguments->overrides.body_model,
                  "Body model of .npz leaders; overrides the recipe")
      ->type_name("FILE")
      ->group(kGroup);
  AddParsed<std::string>(
      app, "--level", batch::kLevelForm, ParseLevelText,
      [arguments](std::string level) { arguments->overrides.level = std::move(level); },
      "Vertical of the camera that captured all leaders, in metres, y up; auto: estimated from "
      "all of them, which are levelled only if the evidence is strong; overrides the recipe")
      ->take_last()
      ->group(kGroup);
  app->add_option("--limit", arguments->limit, "Make only the first items of the plan")
      ->check(Undescribed(CLI::Range(int64_t{0}, std::numeric_limits<int64_t>::max())))
      ->type_name("COUNT")
      ->group(kGroup);
  app->add_option("--sample", arguments->share,
                  "Make only this share of the items, 0 to 1, to look at the result")
      ->check(Undescribed(CLI::Range(0.0, 1.0)))
      ->type_name("SHARE")
      ->group(kGroup);
  AddParsed<batch::Shard>(
      app, "--shard", "INDEX/COUNT", batch::ParseShard,
      [arguments](batch::Shard shard) { arguments->shard = shard; },
      "Make only this part of the items, in its own folder below --out (default: from the "
      "environment of Kubernetes, Slurm or AWS Batch)")
      ->take_last()
      ->group(kGroup);
}

void AddOutputFlags(CLI::App* app, BatchArguments* arguments) {
  static constexpr char kGroup[] = "Output";
  app->add_option("--out", arguments->out, "Folder of the data set")
      ->type_name("FOLDER")
      ->group(kGroup);
  AddChoice<batch::Packing>(
      app, "--pack", kPackings,
      [arguments](batch::Packing packing) { arguments->overrides.packing = packing; },
      "Files in folders, npz shards or WebDataset tar shards; overrides the recipe")
      ->group(kGroup);
  app->add_option("--rate", arguments->overrides.frame_rate_hz,
                  "Resample leader and follower of every item to this rate; overrides the recipe")
      ->check(AboveZero())
      ->type_name("HZ")
      ->group(kGroup);
  const auto add_share = [app](const char* flag, const char* what, std::optional<double>* share) {
    app->add_option(flag, *share, what)
        ->check(Undescribed(CLI::Range(0.0, 1.0)))
        ->type_name("SHARE")
        ->group(kGroup);
  };
  add_share("--validation",
            "Share of leaders whose items are for validation, 0 to below 1; overrides the recipe",
            &arguments->overrides.validation);
  add_share("--test", "Share of leaders whose items are for testing; overrides the recipe",
            &arguments->overrides.test);
  app->add_option("--retries-per-item", arguments->overrides.retries_per_item,
                  "Other seeds to try if the filter rejects an answer; overrides the recipe")
      ->check(Undescribed(CLI::Range(0, 100)))
      ->type_name("COUNT")
      ->group(kGroup);
  app->add_flag("--retry-failed", arguments->retry_failed,
                "Retry items that failed permanently; a packed set gets new shards for them")
      ->group(kGroup);
  app->add_flag("--dry-run", arguments->dry_run,
                "Check every line and leader, request one answer, and estimate time and disk space")
      ->group(kGroup);
  app->add_flag("--json", arguments->json, "Print events and the summary as JSON lines")
      ->group(kGroup);
  app->add_flag("--quiet", arguments->quiet, "Print only errors")->group(kGroup);
}

void AddFlowFlags(CLI::App* app, BatchArguments* arguments) {
  app->add_option("--server", arguments->servers,
                  "Server, or any gRPC target such as dns:///pool:50051; repeatable")
      ->allow_extra_args(false)
      ->capture_default_str()
      ->type_name("HOST:PORT")
      ->group(kServerGroup);
  AddConnectionFlags(app, &arguments->connection);
  app->add_option("--max-in-flight", arguments->max_in_flight,
                  "Maximum number of concurrent calls to each server; the actual number adapts")
      ->check(Undescribed(CLI::Range(1, 256)))
      ->capture_default_str()
      ->type_name("COUNT")
      ->group(kServerGroup);
  app->add_option("--channels", arguments->channels, "Number of connections to each server")
      ->check(Undescribed(CLI::Range(1, 16)))
      ->capture_default_str()
      ->type_name("COUNT")
      ->group(kServerGroup);
  app->add_option("--patience", arguments->patience_seconds,
                  "Seconds for which all servers may be away before the run ends")
      ->check(Undescribed(CLI::Range(0.0, 86400.0)))
      ->capture_default_str()
      ->type_name("SECONDS")
      ->group(kServerGroup);
}

CLI::App* AddFolderCommand(CLI::App* app, const char* name, const char* help, Action action,
                           BatchArguments* arguments) {
  CLI::App* command = app->add_subcommand(name, help);
  command->add_option("folder", arguments->out, "Folder of the data set")
      ->required()
      ->type_name("FOLDER");
  command->add_flag("--json", arguments->json, "Print JSON");
  command->callback([arguments, action] { arguments->action = action; });
  return command;
}

void AddVerifyCommand(CLI::App* app, BatchArguments* arguments) {
  CLI::App* command =
      AddFolderCommand(app, "verify", "Compare every file of a data set with its recorded digest",
                       Action::kVerify, arguments);
  command->add_flag("--repair", arguments->repair,
                    "Make files that are missing or were changed again, like the last run");
  command
      ->add_option("--server", arguments->repairers,
                   "With --repair: server to use instead of those of the last run; repeatable")
      ->allow_extra_args(false)
      ->type_name("HOST:PORT");
  command->footer(kVerifyFooter);
}

// Checks flags that depend on each other.
void CheckTogether(const BatchArguments& arguments) {
  if (arguments.leaders.empty() && arguments.manifest.empty()) {
    throw CLI::RequiredError("leaders or --manifest");
  }
  if (arguments.recipe.empty()) throw CLI::RequiredError("--recipe");
  if (arguments.out.empty()) throw CLI::RequiredError("--out");
}

}  // namespace

CLI::App* AddBatchFlags(CLI::App* program, BatchArguments* arguments) {
  CLI::App* command =
      program->add_subcommand("batch", "Turn many leaders and a recipe into a data set");
  AddInputFlags(command, arguments);
  AddOutputFlags(command, arguments);
  AddFlowFlags(command, arguments);
  command->footer(kBatchFooter);
  AddFolderCommand(command, "merge", "Join the shards below a folder into one data set",
                   Action::kMerge, arguments);
  AddVerifyCommand(command, arguments);
  command->callback([command, arguments] {
    if (command->get_subcommands().empty()) CheckTogether(*arguments);
  });
  return command;
}

absl::StatusOr<BatchArguments> ParseBatch(const std::vector<std::string>& words) {
  CLI::App program;
  BatchArguments arguments;
  AddBatchFlags(&program, &arguments);
  try {
    // CLI11 takes the arguments in reverse.
    program.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    return absl::InvalidArgumentError(error.what());
  }
  if (!program.got_subcommand("batch")) return absl::InvalidArgumentError("not a batch command");
  arguments.words = words;
  return arguments;
}

}  // namespace duet::client::cli
