#include <atomic>
#include <cstdlib>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/str_join.h"
#include "client/batch/gather.h"
#include "client/batch/job.h"
#include "client/batch/leader_source.h"
#include "client/batch/level.h"
#include "client/batch/plan_check.h"
#include "client/batch/survey.h"
#include "client/cli/batch_flags.h"
#include "client/cli/batch_plan.h"
#include "client/cli/batch_progress.h"
#include "client/cli/batch_report.h"
#include "client/cli/batch_servers.h"
#include "client/cli/command.h"
#include "client/cli/stop_signals.h"
#include "client/model_skeleton.h"

namespace duet::client::cli {
namespace {

absl::StatusOr<batch::Shard> ShardOf(const BatchArguments& arguments) {
  if (arguments.shard.has_value()) return *arguments.shard;
  return batch::ShardFromEnvironment([](const char* name) -> std::optional<std::string> {
    const char* value = std::getenv(name);
    if (value == nullptr) return std::nullopt;
    return std::string(value);
  });
}

// The job that a signal stops. A signal may arrive before the job exists.
//
// Threads: safe to call concurrently.
class RunningJob {
 public:
  void Set(batch::Job* job) {
    const std::lock_guard<std::mutex> lock(mutex_);
    job_ = job;
    if (stopped_ && job_ != nullptr) job_->Stop();
  }
  void Stop() {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
    if (job_ != nullptr) job_->Stop();
  }
  bool stopped() const { return stopped_; }

 private:
  std::mutex mutex_;
  batch::Job* job_ = nullptr;
  std::atomic<bool> stopped_{false};
};

batch::JobOptions ToJobOptions(const BatchArguments& arguments) {
  batch::JobOptions options;
  options.calls.max_in_flight = arguments.max_in_flight;
  options.patience = absl::ToChronoNanoseconds(absl::Seconds(arguments.patience_seconds));
  options.limit = arguments.limit;
  options.share = arguments.share;
  return options;
}

ProgressDisplay::Kind DisplayKind(const BatchArguments& arguments,
                                  const ProgramEnvironment& environment) {
  if (arguments.json) return ProgressDisplay::Kind::kEvents;
  if (arguments.quiet) return ProgressDisplay::Kind::kNone;
  return environment.err_is_terminal ? ProgressDisplay::Kind::kTerminal
                                     : ProgressDisplay::Kind::kLines;
}

ExitCode CodeOf(const batch::JobReport& report, bool allowed, bool stopped) {
  if (stopped || report.unfinished > 0 || !report.complete()) return kExitRetry;
  return allowed ? kExitDone : kExitBadInput;
}

absl::StatusOr<ExitCode> RunJob(const BatchArguments& arguments, batch::Job& job,
                                const std::filesystem::path& folder, const batch::PlanCheck& check,
                                const ProgramEnvironment& environment, const RunningJob& running) {
  absl::StatusOr<batch::JobReport> report;
  {
    const ProgressDisplay display(DisplayKind(arguments, environment), job, check.items,
                                  arguments.json ? *environment.out : *environment.err);
    report = job.Run();
  }
  if (!report.ok()) return report.status();
  const bool allowed = arguments.allow_failed.Allows(report->set.failed_leaders, check.files);
  Report(arguments, folder, *report, allowed, environment);
  if (!report->stopped.ok()) return report->stopped;
  return CodeOf(*report, allowed, running.stopped());
}

// The state that a run and a dry run share.
struct Prepared {
  batch::Recipe recipe;
  batch::Shard shard;
  std::vector<ModelInfo> models;
  RequestLimits limits;
  std::vector<motion::Skeleton> skeletons;
  std::vector<std::vector<Client>> servers;
};

absl::Status Prepare(const BatchArguments& arguments, const ProgramEnvironment& environment,
                     const batch::JobIdentity& begun, Prepared* prepared) {
  absl::StatusOr<ResolvedModels> resolved =
      AskModels(arguments, environment, prepared->recipe, begun.models);
  if (!resolved.ok()) return resolved.status();
  for (const ModelInfo& model : resolved->models) {
    absl::StatusOr<motion::Skeleton> skeleton = ToSkeleton(model);
    if (!skeleton.ok()) return skeleton.status();
    prepared->skeletons.push_back(*std::move(skeleton));
  }
  prepared->models = std::move(resolved->models);
  prepared->limits = resolved->limits;
  absl::StatusOr<std::vector<std::vector<Client>>> servers = Connect(arguments, environment);
  if (!servers.ok()) return servers.status();
  prepared->servers = *std::move(servers);
  return absl::OkStatus();
}

// Checks every line of the manifest, and every leader of the part that has an item which `survey`
// (may be null) does not find settled.
absl::StatusOr<batch::PlanCheck> Check(const BatchArguments& arguments,
                                       const ProgramEnvironment& environment,
                                       const Prepared& prepared, batch::Survey* survey,
                                       const std::function<bool()>& stopped) {
  std::vector<std::string> passed_over;
  absl::StatusOr<batch::Plan> plan =
      MakePlan(arguments, prepared.recipe, prepared.models, environment.in, &passed_over);
  if (!plan.ok()) return plan.status();
  ReportPassedOver(arguments, passed_over, environment);
  batch::PlanPart part{prepared.shard, arguments.limit, arguments.share, nullptr};
  if (survey != nullptr) {
    part.is_settled = [survey](const batch::Item& item) { return survey->Add(item); };
  }
  absl::StatusOr<batch::PlanCheck> check =
      CheckPlan(prepared.recipe, prepared.skeletons, prepared.limits, part, &*plan, stopped);
  if (check.ok()) ReportIndexedSides(arguments, plan->indexed_sides(), environment);
  return check;
}

// Chooses the vertical of the leaders if the recipe leaves it open: that which the set was begun
// with, or for a new set that of a strong estimate.
absl::Status ChooseVertical(const BatchArguments& arguments, const ProgramEnvironment& environment,
                            const batch::JobIdentity& begun, const std::function<bool()>& stopped,
                            Prepared* prepared) {
  batch::LeaderInput& input = prepared->recipe.input;
  if (!input.level.automatic) return absl::OkStatus();
  if (!begun.models.empty()) {
    input.up = begun.up;
    return absl::OkStatus();
  }
  // A manifest on standard input can be read only once.
  if (arguments.manifest == "-" && arguments.manifest_copy.empty()) return absl::OkStatus();
  const absl::StatusOr<std::unique_ptr<batch::LeaderSource>> leaders =
      OpenLeaders(arguments, prepared->recipe, nullptr, nullptr);
  if (!leaders.ok()) return leaders.status();
  const batch::Levelled levelled =
      batch::LevelBy(EstimateVertical(input, prepared->skeletons.front(), leaders->get(), stopped));
  input.up = levelled.up;
  if (!arguments.quiet && !arguments.json) *environment.err << "leaders " << levelled.note << "\n";
  return absl::OkStatus();
}

absl::StatusOr<ExitCode> RunDry(const BatchArguments& arguments,
                                const ProgramEnvironment& environment, Prepared prepared) {
  const batch::JobIdentity begun =
      batch::ReadJobIdentity(ShardFolder(arguments.out, prepared.shard))
          .value_or(batch::JobIdentity());
  absl::Status status = Prepare(arguments, environment, begun, &prepared);
  if (status.ok()) {
    status = ChooseVertical(
        arguments, environment, begun, [] { return false; }, &prepared);
  }
  if (!status.ok()) return status;
  const absl::StatusOr<batch::PlanCheck> check =
      Check(arguments, environment, prepared, nullptr, [] { return false; });
  if (!check.ok()) return check.status();
  const bool good = check->bad_line_count == 0 &&
                    arguments.allow_failed.Allows(check->bad_leader_count, check->files);
  absl::StatusOr<batch::Estimate> estimate = batch::Estimate();
  if (check->bad_line_count == 0) {
    estimate = EstimateJob(prepared.recipe, prepared.models, prepared.skeletons, prepared.limits,
                           *check, prepared.servers.front().front());
    if (!estimate.ok()) {
      ReportBadLeaders(arguments, *check, environment);
      return estimate.status();
    }
  }
  Report(arguments, *check, *estimate, environment);
  return good ? kExitDone : kExitBadInput;
}

absl::StatusOr<ExitCode> RunWhole(const BatchArguments& arguments,
                                  const ProgramEnvironment& environment, Prepared prepared) {
  RunningJob running;
  const StopSignals signals([&running] { running.Stop(); });
  batch::JobFolder folder(ShardFolder(arguments.out, prepared.shard));
  batch::JobIdentity begun;
  const batch::JobIdentity wanted = IdentityOf(prepared.recipe, prepared.shard);
  absl::Status status = folder.Open(wanted, &begun);
  if (status.ok() && prepared.shard.count == 1) {
    const absl::StatusOr<batch::Gathered> gathered = GatherShards(wanted, folder, &begun);
    status = gathered.status();
    if (status.ok()) ReportGathered(arguments, *gathered, environment);
  }
  if (status.ok()) status = Prepare(arguments, environment, begun, &prepared);
  if (!status.ok()) return status;
  BatchArguments repeatable = arguments;
  status = CopyManifest(folder.temporary(), environment.in, &repeatable);
  if (status.ok()) {
    status = ChooseVertical(
        repeatable, environment, begun, [&running] { return running.stopped(); }, &prepared);
  }
  if (!status.ok()) return status;
  const batch::JobIdentity identity = IdentityOf(prepared.recipe, prepared.shard, prepared.models);
  status = CheckWeights(begun, identity);
  if (!status.ok()) return status;
  const absl::StatusOr<std::unique_ptr<batch::Survey>> survey =
      batch::Survey::Open(folder, identity, arguments.repeats);
  if (!survey.ok()) return survey.status();
  const absl::StatusOr<batch::PlanCheck> check = Check(
      repeatable, environment, prepared, survey->get(), [&running] { return running.stopped(); });
  if (!check.ok()) return check.status();
  ReportBadLeaders(arguments, *check, environment);
  status = BadLinesError(*check);
  if (!status.ok()) return status;
  if (running.stopped()) return kExitRetry;
  absl::StatusOr<batch::Plan> plan =
      MakePlan(repeatable, prepared.recipe, prepared.models, nullptr, nullptr);
  if (!plan.ok()) return plan.status();
  // Until now, another recipe could still use the folder.
  if (begun.models.empty()) status = folder.Begin(identity);
  if (!status.ok()) return status;
  batch::Job job({std::move(prepared.recipe), prepared.shard, std::move(prepared.models),
                  std::move(prepared.skeletons), prepared.limits, std::move(prepared.servers),
                  &folder, survey->get(), check->items, check->whole_plan},
                 *std::move(plan), ToJobOptions(arguments));
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
  Prepared prepared;
  absl::StatusOr<batch::Recipe> recipe = batch::ReadRecipe(arguments.recipe, arguments.overrides);
  if (!recipe.ok()) return recipe.status();
  prepared.recipe = *std::move(recipe);
  const absl::StatusOr<batch::Shard> shard = ShardOf(arguments);
  if (!shard.ok()) return shard.status();
  prepared.shard = *shard;
  return arguments.dry_run ? RunDry(arguments, environment, std::move(prepared))
                           : RunWhole(arguments, environment, std::move(prepared));
}

}  // namespace

Command AddBatchCommand(CLI::App* program) {
  const auto arguments = std::make_shared<BatchArguments>();
  Command command;
  command.app = AddBatchFlags(program, arguments.get());
  command.run = [arguments](const ProgramEnvironment& environment) {
    return RunBatch(*arguments, environment);
  };
  command.servers = [arguments] { return absl::StrJoin(arguments->servers, ", "); };
  return command;
}

}  // namespace duet::client::cli
