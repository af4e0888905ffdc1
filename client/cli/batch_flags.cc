#include "client/cli/batch_flags.h"

#include <limits>
#include <string>

#include "client/batch/level.h"
#include "client/cli/flags.h"
#include "client/cli/server.h"
#include "model/base/program_flags.h"

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

void AddInputFlags(CLI::App* app, BatchArguments* arguments) {
  constexpr char kGroup[] = "Input";
  CLI::Option* leaders =
      app->add_option("leaders", arguments->leaders, "Motion files, and folders of them")
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
      ->type_name("FORMAT")
      ->group(kGroup);
  AddParsed(
      app, "--level", batch::kLevelForm, ParseLevelText, &arguments->overrides.level,
      "Vertical of the camera that captured all leaders, in metres, y up; auto: estimated from "
      "all of them, which are levelled only if the evidence is strong; overrides the recipe")
      ->group(kGroup);
  app->add_option("--limit", arguments->limit, "Make only the first items of the plan")
      ->check(CLI::Range(int64_t{0}, std::numeric_limits<int64_t>::max()))
      ->type_name("COUNT")
      ->group(kGroup);
  app->add_option("--sample", arguments->share,
                  "Make only this share of the items, 0 to 1, to look at the result")
      ->check(base::InRange(0.0, 1.0))
      ->type_name("SHARE")
      ->group(kGroup);
  AddParsed(app, "--shard", "INDEX/COUNT", batch::ParseShard, &arguments->shard,
            "Make only this part of the items, in its own folder below --out (default: from the "
            "environment of Kubernetes, Slurm or AWS Batch)")
      ->group(kGroup);
}

void AddOutputFlags(CLI::App* app, BatchArguments* arguments) {
  static constexpr char kGroup[] = "Output";
  app->add_option("--out", arguments->out, "Folder of the data set")
      ->type_name("FOLDER")
      ->group(kGroup);
  app->add_option("--rate", arguments->overrides.frame_rate_hz,
                  "Resample leader and follower of every item to this rate; overrides the recipe")
      ->check(AboveZero())
      ->type_name("HZ")
      ->group(kGroup);
  app->add_option("--retries-per-item", arguments->overrides.retries_per_item,
                  "Other seeds to try if the filter rejects an answer; overrides the recipe")
      ->check(base::InRange(0, 100))
      ->type_name("COUNT")
      ->group(kGroup);
  app->add_flag("--retry-failed", arguments->repeats.failed, "Retry items that failed permanently")
      ->group(kGroup);
  app->add_flag("--verify", arguments->repeats.changed,
                "Read every file of earlier runs, and make those that were changed again")
      ->group(kGroup);
  AddParsed(app, "--allow-failed", batch::kAllowedFailuresForm, batch::ParseAllowedFailures,
            &arguments->allow_failed,
            "Exit with 0 although this many leaders, or this share of them, have items that failed "
            "permanently")
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
      ->check(base::InRange(1, 256))
      ->capture_default_str()
      ->type_name("COUNT")
      ->group(kServerGroup);
  app->add_option("--channels", arguments->channels, "Number of connections to each server")
      ->check(base::InRange(1, 16))
      ->capture_default_str()
      ->type_name("COUNT")
      ->group(kServerGroup);
  app->add_option("--patience", arguments->patience_seconds,
                  "Seconds for which all servers may be away before the run ends")
      ->check(base::InRange(0.0, 86400.0))
      ->capture_default_str()
      ->type_name("SECONDS")
      ->group(kServerGroup);
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

CLI::App* AddBatchFlags(CLI::App* program, BatchArguments* arguments) {
  CLI::App* command =
      program->add_subcommand("batch", "Turn many leaders and a recipe into a data set");
  AddInputFlags(command, arguments);
  AddOutputFlags(command, arguments);
  AddFlowFlags(command, arguments);
  command->footer(kBatchFooter);
  command->callback([arguments] { CheckTogether(*arguments); });
  return command;
}

}  // namespace duet::client::cli
