#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <ostream>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/strip.h"
#include "absl/time/time.h"
#include "client/batch/job.h"
#include "client/batch/job_folder.h"
#include "client/batch/leaders.h"
#include "client/batch/plan.h"
#include "client/batch/survey.h"
#include "client/batch/text_values.h"
#include "client/cli/command.h"
#include "client/cli/flags.h"
#include "client/cli/server.h"
#include "client/cli/stop_signals.h"
#include "client/model_skeleton.h"
#include "model/base/counted.h"
#include "model/base/program_flags.h"

namespace duet::client::cli {
namespace {

// Maximum time to wait for a server before a run begins.
constexpr double kFirstAnswerSeconds = 30;

// The share of a run's leaders that may have items that fail permanently, without the run counting
// as failed: "2%" is 0.02.
absl::StatusOr<double> ParseAllowedFailures(absl::string_view text) {
  double percent = 0;
  absl::string_view number = text;
  if (absl::ConsumeSuffix(&number, "%") && absl::SimpleAtod(number, &percent) && percent >= 0 &&
      percent <= 100) {
    return percent / 100;
  }
  return batch::Expected("a share of the leaders from 0% to 100%", text);
}

struct BatchArguments {
  std::vector<std::string> leaders;  // files, folders
  std::string manifest;              // a file, or empty
  std::filesystem::path recipe;
  std::filesystem::path out;
  ServerArguments server;
  batch::Shard shard;
  int max_in_flight = batch::flow::Options().max_in_flight;
  double patience_seconds = 120;
  int64_t limit = std::numeric_limits<int64_t>::max();
  batch::Repeats repeats;
  double allow_failed = 0;  // a share of the leaders

  bool Allows(int64_t failed_leaders, int64_t all_leaders) const {
    return static_cast<double>(failed_leaders) <= allow_failed * static_cast<double>(all_leaders);
  }
  bool dry_run = false;
  bool quiet = false;
};

// The leaders that the flags name.
absl::StatusOr<std::unique_ptr<batch::LeaderSource>> OpenLeaders(const BatchArguments& arguments) {
  if (arguments.manifest.empty()) return batch::ListLeaders(arguments.leaders);
  auto file = std::make_unique<std::ifstream>(arguments.manifest);
  if (!file->is_open()) {
    return absl::NotFoundError(absl::StrCat(arguments.manifest, ": cannot be opened"));
  }
  const std::filesystem::path folder = std::filesystem::path(arguments.manifest).parent_path();
  return batch::ReadManifest(std::move(file), folder, arguments.manifest);
}

// Asks for the models that the set was begun with, or for the recipe's.
absl::Status AskModels(const BatchArguments& arguments, const ProgramEnvironment& environment,
                       const batch::v1::Job& begun, batch::SetSource* prepared) {
  absl::StatusOr<ClientOptions> options = ToClientOptions(arguments.server);
  if (!options.ok()) return options.status();
  options->deadline = options->wait =
      absl::Seconds(std::max(0.1, std::min(arguments.patience_seconds, kFirstAnswerSeconds)));
  const absl::StatusOr<Client> client = environment.connect(*options);
  if (!client.ok()) return client.status();
  std::vector<ModelChoice> choices;
  for (const batch::v1::Job::Model& model : begun.models()) {
    choices.push_back(*batch::ParseModelChoice(model.name()));
  }
  if (choices.empty()) choices = prepared->recipe.models;
  for (const ModelChoice& choice : choices) {
    absl::StatusOr<ModelDetails> details = client->GetModel(choice);
    if (!details.ok()) return details.status();
    absl::StatusOr<motion::Skeleton> skeleton = ToSkeleton(details->model);
    if (!skeleton.ok()) return skeleton.status();
    prepared->models.push_back(std::move(details->model));
    prepared->skeletons.push_back(*std::move(skeleton));
  }
  return absl::OkStatus();
}

absl::StatusOr<batch::Plan> MakePlan(const BatchArguments& arguments,
                                     const batch::SetSource& prepared) {
  absl::StatusOr<std::unique_ptr<batch::LeaderSource>> leaders = OpenLeaders(arguments);
  if (!leaders.ok()) return leaders.status();
  return batch::Plan::Create(prepared.recipe, prepared.models, *std::move(leaders));
}

absl::StatusOr<ExitCode> RunDry(const BatchArguments& arguments,
                                const ProgramEnvironment& environment, batch::SetSource prepared) {
  const batch::v1::Job begun =
      batch::ReadJob(ShardFolder(arguments.out, arguments.shard)).value_or(batch::v1::Job());
  const absl::Status status = AskModels(arguments, environment, begun, &prepared);
  if (!status.ok()) return status;
  batch::LastLeaders leaders(prepared.skeletons.size());
  int64_t frames = 0;
  std::set<std::string> bad;  // messages
  // Reads the leader of each item, and reports once each that cannot be used.
  const auto read = [&](const batch::Item& item) {
    const std::shared_ptr<batch::SharedLeader> shared =
        leaders.Get(item.leader, item.side, item.model);
    const absl::StatusOr<batch::LoadedLeader>& leader =
        shared->Get(prepared.recipe.input, prepared.skeletons[static_cast<size_t>(item.model)]);
    if (leader.ok()) {
      frames += leader->clip.frame_count();
    } else if (bad.insert(std::string(leader.status().message())).second) {
      *environment.err << "cannot be used: " << leader.status().message() << "\n";
    }
    return absl::OkStatus();
  };
  absl::StatusOr<batch::Plan> plan = MakePlan(arguments, prepared);
  if (!plan.ok()) return plan.status();
  const absl::StatusOr<batch::PlanCheck> check =
      CheckPlan({arguments.shard, arguments.limit}, &*plan, read);
  if (!check.ok()) return check.status();
  *environment.out << base::Counted(check->items, "item") << " of "
                   << base::Counted(check->leaders, "leader") << ", "
                   << base::Counted(frames, "frame") << "\n";
  const absl::Status lines = BadLinesError(*check);
  if (!lines.ok()) return lines;
  const bool allowed = arguments.Allows(static_cast<int64_t>(bad.size()), check->files);
  return allowed ? kExitDone : kExitBadInput;
}

int64_t ItemsOfRun(const batch::Progress& progress) {
  return progress.done + progress.rejected + progress.failed + progress.unfinished;
}

// One line about how far a run is: items, rate, time left, refusals and failures.
std::string ProgressLine(const batch::Progress& progress, int64_t total, double seconds) {
  const int64_t made = ItemsOfRun(progress), left = total - progress.resumed - made;
  const double rate = seconds > 0 ? static_cast<double>(made) / seconds : 0;
  std::string line =
      absl::StrFormat("%d of %d items, %.1f a second", progress.resumed + made, total, rate);
  if (rate > 0) {
    const auto seconds_left =
        static_cast<int64_t>(static_cast<double>(std::max<int64_t>(left, 0)) / rate);
    absl::StrAppend(&line, ", ", absl::FormatDuration(absl::Seconds(seconds_left)), " left");
  }
  absl::StrAppend(&line, ", ", progress.calls.in_flight, " of ", progress.calls.limit,
                  " calls at once");
  const std::pair<const char*, int64_t> counts[] = {{"refusals", progress.calls.refusals},
                                                    {"rejected", progress.rejected},
                                                    {"failed", progress.failed},
                                                    {"unfinished", progress.unfinished}};
  for (const auto& [what, count] : counts) {
    if (count > 0) absl::StrAppend(&line, ", ", count, " ", what);
  }
  return line;
}

// Shows the progress of a run while it lives: in place on a terminal, otherwise a line every ten
// seconds.
class ProgressDisplay {
 public:
  // `total`: items that the run makes or has. Job and environment outlive the display.
  ProgressDisplay(const batch::Job& job, int64_t total, const ProgramEnvironment& environment)
      : job_(job), total_(total), environment_(environment) {
    shower_ = std::thread([this] { ShowUntilEnd(); });
  }
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;
  ~ProgressDisplay() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      end_ = true;
    }
    ended_.notify_all();
    shower_.join();
    Show();
    if (environment_.err_is_terminal) *environment_.err << "\n" << std::flush;
  }

 private:
  void Show() {
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const std::string line = ProgressLine(job_.progress(), total_, seconds);
    if (environment_.err_is_terminal) {
      // Returns to the start of the line, and clears the rest of the previous text.
      *environment_.err << "\r" << line << "\x1b[K" << std::flush;
    } else {
      *environment_.err << line << "\n" << std::flush;
    }
  }
  void ShowUntilEnd() {
    const std::chrono::milliseconds interval(environment_.err_is_terminal ? 200 : 10000);
    std::unique_lock<std::mutex> lock(mutex_);
    while (!ended_.wait_for(lock, interval, [this] { return end_; })) Show();
  }

  const batch::Job& job_;
  const int64_t total_;
  const ProgramEnvironment& environment_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  std::thread shower_;
};

void Report(const BatchArguments& arguments, const std::filesystem::path& folder,
            const batch::JobReport& report, bool failures_allowed,
            const ProgramEnvironment& environment) {
  const batch::SetCounts& set = report.set;
  const int64_t missing = report.planned - set.done - set.rejected - set.failed;
  if (!arguments.quiet) {
    *environment.out << folder.string() << ": " << set.done << " done, " << set.rejected
                     << " rejected, " << set.failed << " failed, " << missing << " missing\n";
  }
  std::ostream& err = *environment.err;
  if (report.planned == 0) {
    err << "duet: the plan has no items: the list of leaders is empty, or --limit or --shard "
           "leaves none\n";
  }
  if (set.failed > 0) {
    err << base::Counted(set.failed, "item") << " of "
        << base::Counted(set.failed_leaders, "leader") << " failed permanently ("
        << (folder / "failed.jsonl").string() << "), the first: " << set.first_failure << "\n";
    if (failures_allowed) err << "duet: --allow-failed permits them\n";
  }
  if (report.unfinished > 0) {
    err << base::Counted(report.unfinished, "item")
        << " failed temporarily; run the command again. The first: " << report.first_unfinished
        << "\n";
  }
}

absl::StatusOr<ExitCode> RunJob(const BatchArguments& arguments, batch::Job& job,
                                const std::filesystem::path& folder, const batch::PlanCheck& check,
                                const ProgramEnvironment& environment,
                                const Stopper<batch::Job>& running) {
  absl::StatusOr<batch::JobReport> report;
  {
    std::optional<ProgressDisplay> display;
    if (!arguments.quiet) display.emplace(job, check.items, environment);
    report = job.Run();
  }
  if (!report.ok()) return report.status();
  const bool allowed = arguments.Allows(report->set.failed_leaders, check.files);
  Report(arguments, folder, *report, allowed, environment);
  if (!report->stopped.ok()) return report->stopped;
  if (running.stopped() || report->unfinished > 0 || !report->complete()) return kExitRetry;
  return allowed ? kExitDone : kExitBadInput;
}

// Opens the set, joins the shards of its job, and compares its models with the servers'.
absl::Status OpenSet(const BatchArguments& arguments, const ProgramEnvironment& environment,
                     batch::JobFolder* folder, batch::v1::Job* begun, batch::SetSource* prepared) {
  const batch::v1::Job wanted = IdentityOf(prepared->recipe, arguments.shard);
  absl::Status status = folder->Open(wanted, begun);
  if (status.ok() && arguments.shard.count == 1) {
    const absl::StatusOr<batch::Gathered> gathered = GatherShards(wanted, *folder, begun);
    status = gathered.status();
    if (status.ok() && gathered->shards > 0 && !arguments.quiet) {
      *environment.err << "gathered " << gathered->shards << " of " << gathered->count
                       << " shards, " << base::Counted(gathered->items, "item") << "\n";
    }
  }
  if (status.ok()) status = AskModels(arguments, environment, *begun, prepared);
  if (!status.ok()) return status;
  return batch::CheckWeights(*begun,
                             IdentityOf(prepared->recipe, arguments.shard, prepared->models));
}

absl::StatusOr<ExitCode> RunWhole(const BatchArguments& arguments,
                                  const ProgramEnvironment& environment,
                                  batch::SetSource prepared) {
  Stopper<batch::Job> running;
  const StopSignals signals([&running] { running.Stop(); });
  batch::JobFolder folder(ShardFolder(arguments.out, arguments.shard));
  batch::v1::Job begun;
  absl::Status status = OpenSet(arguments, environment, &folder, &begun, &prepared);
  if (!status.ok()) return status;
  const absl::StatusOr<std::unique_ptr<batch::Survey>> survey =
      batch::Survey::Open(folder, arguments.repeats);
  if (!survey.ok()) return survey.status();
  absl::StatusOr<batch::Plan> plan = MakePlan(arguments, prepared);
  if (!plan.ok()) return plan.status();
  const absl::StatusOr<batch::PlanCheck> check = CheckPlan(
      {arguments.shard, arguments.limit}, &*plan,
      [&survey](const batch::Item& item) { return (*survey)->Add(item); },
      [&running] { return running.stopped(); });
  if (!check.ok()) return check.status();
  status = BadLinesError(*check);
  if (!status.ok()) return status;
  if (running.stopped()) return kExitRetry;
  plan = MakePlan(arguments, prepared);  // from its first item
  if (!plan.ok()) return plan.status();
  absl::StatusOr<ClientOptions> options = ToClientOptions(arguments.server);
  if (!options.ok()) return options.status();
  options->retry.max_attempts = 1;  // the job retries
  absl::StatusOr<Client> client = environment.connect(*options);
  if (!client.ok()) return client.status();
  // Until now, another recipe could still use the folder.
  if (begun.models().empty()) {
    status = folder.Begin(IdentityOf(prepared.recipe, arguments.shard, prepared.models));
  }
  if (!status.ok()) return status;
  batch::JobOptions job_options;
  job_options.calls.max_in_flight = arguments.max_in_flight;
  job_options.patience = absl::ToChronoNanoseconds(absl::Seconds(arguments.patience_seconds));
  job_options.limit = arguments.limit;
  batch::Job job({std::move(prepared), arguments.shard, *std::move(client), &folder, survey->get(),
                  check->items},
                 *std::move(plan), job_options);
  running.Set(&job);
  absl::StatusOr<ExitCode> code =
      RunJob(arguments, job, folder.out(), *check, environment, running);
  running.Set(nullptr);
  return code;
}

absl::StatusOr<ExitCode> RunBatch(const BatchArguments& arguments,
                                  const ProgramEnvironment& environment) {
  const absl::Status inputs = batch::CheckInputs(arguments.leaders, arguments.out);
  if (!inputs.ok()) return inputs;
  batch::SetSource prepared;
  absl::StatusOr<batch::Recipe> recipe = batch::ReadRecipe(arguments.recipe);
  if (!recipe.ok()) return recipe.status();
  prepared.recipe = *std::move(recipe);
  return arguments.dry_run ? RunDry(arguments, environment, std::move(prepared))
                           : RunWhole(arguments, environment, std::move(prepared));
}

constexpr char kFooter[] = R"(
To continue a run that stopped for any reason, run the same command again. docs/batch.md has a tour.
`python3 -m duet_motion.sets` verifies, splits and packs data sets.

Exit codes:
  0   every item is settled: done, or rejected by the recipe's filter
  1   run it again: stopped, a server away, a full disk, items that failed temporarily
  2   the command line is invalid
  42  items of more leaders than --allow-failed permits failed permanently (failed.jsonl), or the
      recipe, the input or the models are rejected

Example:
  duet batch walks/ --recipe mixes.textproto --out set
)";

void AddInputFlags(CLI::App* app, BatchArguments* arguments) {
  constexpr char kGroup[] = "Input";
  CLI::Option* leaders =
      app->add_option("leaders", arguments->leaders, "Motion files, and folders of them")
          ->type_name("LEADER");
  AddValue(app, kGroup, "--manifest", "FILE", &arguments->manifest,
           "List of leaders, tab-separated, one on each line")
      ->excludes(leaders);
  AddValue(app, kGroup, "--recipe", "FILE", &arguments->recipe,
           "Reactions and outputs for each leader: text format, or JSON in a .json file");
  AddValue(app, kGroup, "--limit", "COUNT", &arguments->limit,
           "Make only the first items of the plan")
      ->check(CLI::Range(int64_t{0}, std::numeric_limits<int64_t>::max()));
  AddParsed(app, kGroup, "--shard", "INDEX/COUNT", batch::ParseShard, &arguments->shard,
            "Make only this part of the items, in its own folder below --out; index from 0");
}

void AddOutputFlags(CLI::App* app, BatchArguments* arguments) {
  static constexpr char kGroup[] = "Output";
  AddValue(app, kGroup, "--out", "FOLDER", &arguments->out, "Folder of the data set");
  app->add_flag("--retry-failed", arguments->repeats.failed, "Retry items that failed permanently")
      ->group(kGroup);
  app->add_flag("--verify", arguments->repeats.changed,
                "Read every file of earlier runs, and make those that were changed again")
      ->group(kGroup);
  AddParsed(app, kGroup, "--allow-failed", "PERCENT%", ParseAllowedFailures,
            &arguments->allow_failed,
            "Exit with 0 although this share of the leaders have items that failed permanently");
  app->add_flag("--dry-run", arguments->dry_run,
                "Check every line and every leader, and count items; writes nothing")
      ->group(kGroup);
  app->add_flag("--quiet", arguments->quiet, "Print only errors")->group(kGroup);
}

void AddFlowFlags(CLI::App* app, BatchArguments* arguments) {
  AddValue(app, kServerGroup, "--server", "HOST:PORT", &arguments->server.address,
           "Server, or any gRPC target such as dns:///pool:50051")
      ->envname("DUET_SERVER")
      ->capture_default_str();
  AddConnectionFlags(app, &arguments->server);
  AddValue(app, kServerGroup, "--max-in-flight", "COUNT", &arguments->max_in_flight,
           "Maximum number of concurrent calls; the actual number adapts")
      ->check(base::InRange(1, 256))
      ->capture_default_str();
  AddValue(app, kServerGroup, "--patience", "SECONDS", &arguments->patience_seconds,
           "Seconds for which the server may be away before the run ends")
      ->check(base::InRange(0.0, 86400.0))
      ->capture_default_str();
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

Command AddBatchCommand(CLI::App* program) {
  const auto arguments = std::make_shared<BatchArguments>();
  CLI::App* app =
      program->add_subcommand("batch", "Turn many leaders and a recipe into a data set");
  AddInputFlags(app, arguments.get());
  AddOutputFlags(app, arguments.get());
  AddFlowFlags(app, arguments.get());
  app->footer(kFooter);
  app->callback([arguments] { CheckTogether(*arguments); });
  return MakeCommand(app, arguments, RunBatch);
}

}  // namespace duet::client::cli
