#include "client/cli/batch_flags.h"

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/str_join.h"
#include "client/batch/level.h"
#include "client/cli/flags.h"
#include "client/cli/input_flags.h"
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
  42  items of more leaders than --allow-failed permits failed permanently (failed.tsv), or the
      recipe, the input or the models are rejected

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

void AddInputFlags(FlagSet* app, BatchArguments* arguments) {
  constexpr char kGroup[] = "Input";
  Flag* leaders = app->Add("leaders", &arguments->leaders,
                           "Motion files, folders of them, or patterns (walks/*.bvh)")
                      ->Form("LEADER");
  app->Add("--manifest", &arguments->manifest,
           "List of leaders, one on each line, as JSON objects or TSV; - for standard input")
      ->Excludes(leaders)
      ->Form("FILE")
      ->Group(kGroup);
  app->Add("--recipe", &arguments->recipe,
           "Reactions and outputs for each leader: text format, or JSON in a .json file")
      ->Form("FILE")
      ->Group(kGroup);
  app->Add("--input-format", &arguments->overrides.input_format,
           "Format of every leader; overrides the extension and the recipe")
      ->OneOf(InputFormatNames())
      ->Form(absl::StrJoin(InputFormatNames(), "|"))
      ->Group(kGroup);
  app->Add("--layout", &arguments->overrides.layout,
           "Layout of .npy leaders of research; overrides the recipe")
      ->OneOf(LayoutNames())
      ->Form(absl::StrJoin(LayoutNames(), "|"))
      ->Group(kGroup);
  app->Add("--body-model", &arguments->overrides.body_model,
           "Body model of .npz leaders; overrides the recipe")
      ->Form("FILE")
      ->Group(kGroup);
  AddParsed<std::string>(
      app, "--level", batch::kLevelForm, ParseLevelText,
      [arguments](std::string level) { arguments->overrides.level = std::move(level); },
      "Vertical of the camera that captured all leaders, in metres, y up; auto: estimated from "
      "all of them, which are levelled only if the evidence is strong; overrides the recipe")
      ->LastOnly()
      ->Group(kGroup);
  app->Add("--limit", &arguments->limit, "Make only the first items of the plan")
      ->InRange(int64_t{0}, std::numeric_limits<int64_t>::max())
      ->Form("COUNT")
      ->Group(kGroup);
  app->Add("--sample", &arguments->share,
           "Make only this share of the items, 0 to 1, to look at the result")
      ->InRange(0.0, 1.0)
      ->Form("SHARE")
      ->Group(kGroup);
  AddParsed<batch::Shard>(
      app, "--shard", "INDEX/COUNT", batch::ParseShard,
      [arguments](batch::Shard shard) { arguments->shard = shard; },
      "Make only this part of the items, in its own folder below --out (default: from the "
      "environment of Kubernetes, Slurm or AWS Batch)")
      ->LastOnly()
      ->Group(kGroup);
}

void AddOutputFlags(FlagSet* app, BatchArguments* arguments) {
  static constexpr char kGroup[] = "Output";
  app->Add("--out", &arguments->out, "Folder of the data set")->Form("FOLDER")->Group(kGroup);
  AddChoice<batch::Packing>(
      app, "--pack", kPackings,
      [arguments](batch::Packing packing) { arguments->overrides.packing = packing; },
      "Files in folders, npz shards or WebDataset tar shards; overrides the recipe")
      ->Group(kGroup);
  app->Add("--rate", &arguments->overrides.frame_rate_hz,
           "Resample leader and follower of every item to this rate; overrides the recipe")
      ->AboveZero()
      ->Form("HZ")
      ->Group(kGroup);
  const auto add_share = [app](const char* flag, const char* what, std::optional<double>* share) {
    app->Add(flag, share, what)->InRange(0.0, 1.0)->Form("SHARE")->Group(kGroup);
  };
  add_share("--validation",
            "Share of leaders whose items are for validation, 0 to below 1; overrides the recipe",
            &arguments->overrides.validation);
  add_share("--test", "Share of leaders whose items are for testing; overrides the recipe",
            &arguments->overrides.test);
  app->Add("--retries-per-item", &arguments->overrides.retries_per_item,
           "Other seeds to try if the filter rejects an answer; overrides the recipe")
      ->InRange(0, 100)
      ->Form("COUNT")
      ->Group(kGroup);
  app->AddSwitch("--retry-failed", &arguments->retry_failed,
                 "Retry items that failed permanently; a packed set gets new shards for them")
      ->Group(kGroup);
  AddParsed<batch::AllowedFailures>(
      app, "--allow-failed", batch::kAllowedFailuresForm, batch::ParseAllowedFailures,
      [arguments](batch::AllowedFailures allowed) { arguments->allow_failed = allowed; },
      "Exit with 0 although this many leaders, or this share of them, have items that failed "
      "permanently")
      ->LastOnly()
      ->Group(kGroup);
  app->AddSwitch(
         "--dry-run", &arguments->dry_run,
         "Check every line and leader, request one answer, and estimate time and disk space")
      ->Group(kGroup);
  app->AddSwitch("--json", &arguments->json, "Print events and the summary as JSON lines")
      ->Group(kGroup);
  app->AddSwitch("--quiet", &arguments->quiet, "Print only errors")->Group(kGroup);
}

void AddFlowFlags(FlagSet* app, BatchArguments* arguments) {
  app->Add("--server", &arguments->servers,
           "Server, or any gRPC target such as dns:///pool:50051; repeatable")
      ->OneValueEach()
      ->ShowDefault()
      ->Form("HOST:PORT")
      ->Group(kServerGroup);
  AddConnectionFlags(app, &arguments->connection);
  app->Add("--max-in-flight", &arguments->max_in_flight,
           "Maximum number of concurrent calls to each server; the actual number adapts")
      ->InRange(1, 256)
      ->ShowDefault()
      ->Form("COUNT")
      ->Group(kServerGroup);
  app->Add("--channels", &arguments->channels, "Number of connections to each server")
      ->InRange(1, 16)
      ->ShowDefault()
      ->Form("COUNT")
      ->Group(kServerGroup);
  app->Add("--patience", &arguments->patience_seconds,
           "Seconds for which all servers may be away before the run ends")
      ->InRange(0.0, 86400.0)
      ->ShowDefault()
      ->Form("SECONDS")
      ->Group(kServerGroup);
}

FlagSet* AddFolderCommand(FlagSet* app, const char* name, const char* help, Action action,
                          BatchArguments* arguments) {
  FlagSet* command = app->AddCommand(name, help);
  command->Add("folder", &arguments->out, "Folder of the data set")->Required()->Form("FOLDER");
  command->AddSwitch("--json", &arguments->json, "Print JSON");
  command->Check([arguments, action] { arguments->action = action; });
  return command;
}

void AddVerifyCommand(FlagSet* app, BatchArguments* arguments) {
  FlagSet* command =
      AddFolderCommand(app, "verify", "Compare every file of a data set with its recorded digest",
                       Action::kVerify, arguments);
  command->AddSwitch("--repair", &arguments->repair,
                     "Make files that are missing or were changed again, like the last run");
  command
      ->Add("--server", &arguments->repairers,
            "With --repair: server to use instead of those of the last run; repeatable")
      ->OneValueEach()
      ->Form("HOST:PORT");
  command->Footer(kVerifyFooter);
}

// Checks flags that depend on each other.
void CheckTogether(const BatchArguments& arguments) {
  if (arguments.leaders.empty() && arguments.manifest.empty()) {
    RejectMissing("leaders or --manifest");
  }
  if (arguments.recipe.empty()) RejectMissing("--recipe");
  if (arguments.out.empty()) RejectMissing("--out");
}

}  // namespace

FlagSet* AddBatchFlags(FlagSet* program, BatchArguments* arguments) {
  FlagSet* command = program->AddCommand("batch", "Turn many leaders and a recipe into a data set");
  AddInputFlags(command, arguments);
  AddOutputFlags(command, arguments);
  AddFlowFlags(command, arguments);
  command->Footer(kBatchFooter);
  AddFolderCommand(command, "merge", "Join the shards below a folder into one data set",
                   Action::kMerge, arguments);
  AddVerifyCommand(command, arguments);
  command->Check([command, arguments] {
    if (!command->names_command()) CheckTogether(*arguments);
  });
  return command;
}

absl::StatusOr<BatchArguments> ParseBatch(const std::vector<std::string>& words) {
  FlagSet program;
  BatchArguments arguments;
  const FlagSet* batch = AddBatchFlags(&program, &arguments);
  const ParsedFlags parsed = program.Parse(words);
  if (parsed.outcome != ParsedFlags::Outcome::kDone) {
    return absl::InvalidArgumentError(parsed.error);
  }
  if (!batch->is_given()) return absl::InvalidArgumentError("not a batch command");
  arguments.words = words;
  return arguments;
}

}  // namespace duet::client::cli
