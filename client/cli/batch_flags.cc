#include "client/cli/batch_flags.h"

#include <limits>
#include <map>

#include "client/cli/flags.h"
#include "client/cli/server_flags.h"

namespace duet::client::cli {
namespace {

using Action = BatchArguments::Action;

constexpr char kBatchFooter[] = R"(
Run again with the same words it goes on where it stopped, however it stopped. docs/batch.md has a tour.

Exit codes:
  0   every item is settled: done, or rejected by the recipe's filter
  1   worth running again: stopped, a server away, a full disk, items that failed for now
  2   the command line makes no sense
  42  items failed for good (failed.tsv), or the recipe, the input or the models are refused

Example:
  duet batch walks/ --recipe mixes.textproto --out set
)";

constexpr char kVerifyFooter[] = R"(
What is found is left to the next run: the same duet batch command asks again for it, and so does
--repair, which gives the command of the last run again from the folder where that was started.

Exit codes:
  0   everything is there as it was written
  1   worth running again: items are missing, or the repair was stopped
  42  files are missing or were changed, or the repair is refused
)";

const std::map<std::string, batch::Packing> kPackings = {
    {"none", batch::Packing::kNone}, {"npz", batch::Packing::kNpz}, {"tar", batch::Packing::kTar}};

void AddInputFlags(CLI::App* app, BatchArguments* arguments) {
  constexpr char kGroup[] = "Input";
  CLI::Option* leaders = app->add_option("leaders", arguments->leaders,
                                         "Motion files, folders of them, or patterns (walks/*.bvh)")
                             ->type_name("LEADER");
  app->add_option("--manifest", arguments->manifest,
                  "Leaders line by line, JSON objects or TSV; - reads standard input")
      ->excludes(leaders)
      ->type_name("FILE")
      ->group(kGroup);
  app->add_option("--recipe", arguments->recipe,
                  "What is asked for each leader: text format, or JSON in a .json file")
      ->type_name("FILE")
      ->group(kGroup);
  app->add_option("--input-format", arguments->overrides.input_format,
                  "What every leader is, whatever its name; instead of the recipe's")
      ->check(Undescribed(CLI::IsMember(
          std::vector<std::string>{"amc", "bvh", "csv", "glb", "gltf", "json", "npy", "sbu"})))
      ->type_name("amc|bvh|csv|glb|gltf|json|npy|sbu")
      ->group(kGroup);
  app->add_option("--limit", arguments->limit, "Only the first items of the plan")
      ->check(Undescribed(CLI::Range(int64_t{0}, std::numeric_limits<int64_t>::max())))
      ->type_name("COUNT")
      ->group(kGroup);
  app->add_option("--sample", arguments->share, "Only this share of the items, 0 to 1, for a look")
      ->check(Undescribed(CLI::Range(0.0, 1.0)))
      ->type_name("SHARE")
      ->group(kGroup);
  AddParsed<batch::Shard>(
      app, "--shard", "INDEX/COUNT", batch::ParseShard,
      [arguments](batch::Shard shard) { arguments->shard = shard; },
      "Only this part of the items, in a folder of its own below --out; by default what the "
      "cluster's environment says (Kubernetes, Slurm, AWS Batch)")
      ->take_last()
      ->group(kGroup);
}

void AddOutputFlags(CLI::App* app, BatchArguments* arguments) {
  constexpr char kGroup[] = "Output";
  app->add_option("--out", arguments->out, "Folder of the data set")
      ->type_name("FOLDER")
      ->group(kGroup);
  AddChoice<batch::Packing>(
      app, "--pack", kPackings,
      [arguments](batch::Packing packing) { arguments->overrides.packing = packing; },
      "Files in folders, WebDataset tar shards or npz shards; instead of the recipe's")
      ->group(kGroup);
  app->add_option(
         "--rate", arguments->overrides.frame_rate_hz,
         "Resample leader and follower of every item to this rate; instead of the recipe's")
      ->check(AboveZero())
      ->type_name("HZ")
      ->group(kGroup);
  app->add_option("--retries-per-item", arguments->overrides.retries_per_item,
                  "Other seeds to try while the filter rejects; instead of the recipe's")
      ->check(Undescribed(CLI::Range(0, 100)))
      ->type_name("COUNT")
      ->group(kGroup);
  app->add_flag("--retry-failed", arguments->retry_failed,
                "Ask again for items that failed for good; of a packed set into further shards")
      ->group(kGroup);
  app->add_flag("--dry-run", arguments->dry_run,
                "Check every line and leader, ask for one answer, estimate time and disk")
      ->group(kGroup);
  app->add_flag("--json", arguments->json, "Print events and the summary as JSON lines")
      ->group(kGroup);
  app->add_flag("--quiet", arguments->quiet, "Print errors alone")->group(kGroup);
}

void AddFlowFlags(CLI::App* app, BatchArguments* arguments) {
  app->add_option("--server", arguments->servers,
                  "Or any gRPC target, such as dns:///pool:50051; repeatable")
      ->allow_extra_args(false)
      ->capture_default_str()
      ->type_name("HOST:PORT")
      ->group(kServerGroup);
  AddConnectionFlags(app, &arguments->connection);
  app->add_option("--max-in-flight", arguments->max_in_flight,
                  "Most calls at once at one server; how many there are finds itself")
      ->check(Undescribed(CLI::Range(1, 256)))
      ->capture_default_str()
      ->type_name("COUNT")
      ->group(kServerGroup);
  app->add_option("--channels", arguments->channels, "Connections to each server")
      ->check(Undescribed(CLI::Range(1, 16)))
      ->capture_default_str()
      ->type_name("COUNT")
      ->group(kServerGroup);
  app->add_option("--patience", arguments->patience_seconds,
                  "Seconds that all servers may be away before the run ends")
      ->check(Undescribed(CLI::Range(0.0, 86400.0)))
      ->capture_default_str()
      ->type_name("SECONDS")
      ->group(kServerGroup);
}

CLI::App* AddFolderCommand(CLI::App* app, const char* name, const char* help, Action action,
                           BatchArguments* arguments) {
  CLI::App* command = app->add_subcommand(name, help);
  command->add_option("folder", arguments->out, "The data set")->required()->type_name("FOLDER");
  command->add_flag("--json", arguments->json, "Print JSON");
  command->callback([arguments, action] { arguments->action = action; });
  return command;
}

void AddVerifyCommand(CLI::App* app, BatchArguments* arguments) {
  CLI::App* command = AddFolderCommand(
      app, "verify", "Read every file of a data set and compare it with what was written",
      Action::kVerify, arguments);
  command->add_flag("--repair", arguments->repair,
                    "Ask again for what is missing or was changed, as the last run did");
  command
      ->add_option("--server", arguments->repairers,
                   "With --repair: instead of the last run's servers; repeatable")
      ->allow_extra_args(false)
      ->type_name("HOST:PORT");
  command->footer(kVerifyFooter);
}

// What no single flag can tell.
void CheckTogether(const BatchArguments& arguments) {
  if (arguments.leaders.empty() && arguments.manifest.empty()) {
    throw CLI::RequiredError("leaders or --manifest");
  }
  if (arguments.recipe.empty()) throw CLI::RequiredError("--recipe");
  if (arguments.out.empty()) throw CLI::RequiredError("--out");
}

}  // namespace

CLI::App* AddBatchCommand(CLI::App* app, BatchArguments* arguments) {
  CLI::App* command =
      app->add_subcommand("batch", "Turn many leaders and a recipe into a data set");
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

}  // namespace duet::client::cli
