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

constexpr char kBatchFooter[] = R"(
To continue a run that stopped for any reason, run the same command again. docs/batch.md has a tour.
`python3 -m duet_motion.sets` verifies, merges, splits and packs data sets.

Exit codes:
  0   every item is settled: done, or rejected by the recipe's filter
  1   run it again: stopped, a server away, a full disk, items that failed temporarily
  2   the command line is invalid
  42  items of more leaders than --allow-failed permits failed permanently (failed.tsv), or the
      recipe, the input or the models are rejected

Example:
  duet batch walks/ --recipe mixes.textproto --out set
)";

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
  app->Add("--rate", &arguments->overrides.frame_rate_hz,
           "Resample leader and follower of every item to this rate; overrides the recipe")
      ->AboveZero()
      ->Form("HZ")
      ->Group(kGroup);
  app->Add("--retries-per-item", &arguments->overrides.retries_per_item,
           "Other seeds to try if the filter rejects an answer; overrides the recipe")
      ->InRange(0, 100)
      ->Form("COUNT")
      ->Group(kGroup);
  app->AddSwitch("--retry-failed", &arguments->repeats.failed,
                 "Retry items that failed permanently")
      ->Group(kGroup);
  app->AddSwitch("--verify", &arguments->repeats.changed,
                 "Read every file of earlier runs, and make those that were changed again")
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
  command->Check([arguments] { CheckTogether(*arguments); });
  return command;
}

}  // namespace duet::client::cli
