#include "client/cli/batch_command.h"

#include <atomic>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "client/batch/estimate.h"
#include "client/batch/job.h"
#include "client/batch/merge.h"
#include "client/batch/setup.h"
#include "client/batch/verify.h"
#include "client/cli/batch_plan.h"
#include "client/cli/batch_progress.h"
#include "client/cli/batch_report.h"
#include "client/cli/batch_servers.h"
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

// The job that a signal stops, once there is one.
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
  options.retry_failed = arguments.retry_failed;
  return options;
}

ProgressDisplay::Kind DisplayKind(const BatchArguments& arguments,
                                  const ProgramEnvironment& environment) {
  if (arguments.json) return ProgressDisplay::Kind::kEvents;
  if (arguments.quiet) return ProgressDisplay::Kind::kNone;
  return environment.err_is_terminal ? ProgressDisplay::Kind::kTerminal
                                     : ProgressDisplay::Kind::kLines;
}

ExitCode CodeOf(const batch::JobReport& report, bool stopped) {
  if (stopped || report.unfinished > 0 || !report.complete()) return kExitRetry;
  return report.set.failed > 0 ? kExitBadInput : kExitDone;
}

absl::StatusOr<ExitCode> RunJob(const BatchArguments& arguments, batch::Job& job,
                                const std::filesystem::path& folder,
                                const std::atomic<int64_t>& total,
                                const ProgramEnvironment& environment, const RunningJob& running) {
  absl::StatusOr<batch::JobReport> report;
  {
    const ProgressDisplay display(DisplayKind(arguments, environment), job, total,
                                  arguments.json ? *environment.out : *environment.err);
    report = job.Run();
  }
  if (!report.ok()) return report.status();
  Report(arguments, folder, *report, environment);
  if (!report->stopped.ok()) return report->stopped;
  return CodeOf(*report, running.stopped());
}

// What a run and a dry run have in common.
struct Prepared {
  batch::Recipe recipe;
  batch::Shard shard;
  std::vector<ModelInfo> models;
  std::vector<motion::Skeleton> skeletons;
  std::vector<std::vector<Client>> servers;
};

absl::Status Prepare(const BatchArguments& arguments, const ProgramEnvironment& environment,
                     const std::vector<ModelChoice>& begun, Prepared* prepared) {
  absl::StatusOr<std::vector<ModelInfo>> models =
      AskModels(arguments, environment, prepared->recipe, begun);
  if (!models.ok()) return models.status();
  for (const ModelInfo& model : *models) {
    absl::StatusOr<motion::Skeleton> skeleton = ToSkeleton(model);
    if (!skeleton.ok()) return skeleton.status();
    prepared->skeletons.push_back(*std::move(skeleton));
  }
  prepared->models = *std::move(models);
  absl::StatusOr<std::vector<std::vector<Client>>> servers = Connect(arguments, environment);
  if (!servers.ok()) return servers.status();
  prepared->servers = *std::move(servers);
  return absl::OkStatus();
}

absl::StatusOr<ExitCode> RunDry(const BatchArguments& arguments,
                                const ProgramEnvironment& environment, Prepared prepared) {
  const absl::StatusOr<batch::JobIdentity> begun =
      batch::ReadJobIdentity(ShardFolder(arguments.out, prepared.shard));
  absl::Status status = Prepare(arguments, environment,
                                begun.ok() ? begun->models : std::vector<ModelChoice>(), &prepared);
  if (!status.ok()) return status;
  std::vector<std::string> passed_over;
  absl::StatusOr<batch::Plan> plan =
      MakePlan(arguments, prepared.recipe, prepared.models, environment.in, &passed_over);
  if (!plan.ok()) return plan.status();
  ReportPassedOver(arguments, passed_over, environment);
  const absl::StatusOr<batch::Estimate> estimate =
      EstimateJob(prepared.recipe, prepared.models, prepared.skeletons, prepared.shard,
                  arguments.limit, prepared.servers.front().front(), &*plan);
  if (!estimate.ok()) return estimate.status();
  Report(arguments, *estimate, environment);
  return estimate->unreadable > 0 ? kExitBadInput : kExitDone;
}

absl::StatusOr<ExitCode> RunWhole(const BatchArguments& arguments,
                                  const ProgramEnvironment& environment, Prepared prepared) {
  RunningJob running;
  const StopSignals signals([&running] { running.Stop(); });
  batch::JobFolder folder(ShardFolder(arguments.out, prepared.shard));
  const batch::JobIdentity wanted = IdentityOf(prepared.recipe, prepared.shard);
  batch::JobIdentity begun;
  absl::Status status = folder.Open(wanted, &begun);
  if (status.ok()) status = Prepare(arguments, environment, begun.models, &prepared);
  if (!status.ok()) return status;
  std::vector<std::string> passed_over;
  absl::StatusOr<batch::Plan> plan =
      MakePlan(arguments, prepared.recipe, prepared.models, environment.in, &passed_over);
  if (!plan.ok()) return plan.status();
  ReportPassedOver(arguments, passed_over, environment);
  const batch::JobIdentity identity = WithModels(wanted, prepared.models, prepared.skeletons);
  if (begun.models.empty()) status = folder.Begin(identity);
  if (!status.ok()) return status;
  // What a pipe brings can be read only once.
  const bool countable = arguments.manifest != "-" && arguments.share >= 1;
  const Counting counting(
      countable ? MakePlan(arguments, prepared.recipe, prepared.models, nullptr, nullptr)
                : absl::StatusOr<batch::Plan>(absl::UnavailableError("unknown")),
      prepared.shard, arguments.limit);
  batch::Job job({std::move(prepared.recipe), identity, std::move(prepared.models),
                  std::move(prepared.skeletons), std::move(prepared.servers), &folder},
                 *std::move(plan), ToJobOptions(arguments));
  running.Set(&job);
  absl::StatusOr<ExitCode> code =
      RunJob(arguments, job, folder.out(), counting.total(), environment, running);
  running.Set(nullptr);
  return code;
}

absl::StatusOr<ExitCode> Run(const BatchArguments& arguments,
                             const ProgramEnvironment& environment) {
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

absl::StatusOr<ExitCode> RunMerge(const BatchArguments& arguments,
                                  const ProgramEnvironment& environment) {
  const absl::StatusOr<batch::MergeReport> report = batch::Merge(arguments.out);
  if (!report.ok()) return report.status();
  Report(arguments, *report, environment);
  return report->missing.empty() ? kExitDone : kExitRetry;
}

absl::StatusOr<ExitCode> RunVerify(const BatchArguments& arguments,
                                   const ProgramEnvironment& environment) {
  const absl::StatusOr<batch::VerifyReport> report = batch::Verify(arguments.out);
  if (!report.ok()) return report.status();
  Report(arguments, *report, environment);
  if (report->problem_count > 0) return kExitBadInput;
  return report->missing > 0 ? kExitRetry : kExitDone;
}

}  // namespace

absl::StatusOr<ExitCode> RunBatch(const BatchArguments& arguments,
                                  const ProgramEnvironment& environment) {
  switch (arguments.action) {
    case BatchArguments::Action::kMerge:
      return RunMerge(arguments, environment);
    case BatchArguments::Action::kVerify:
      return RunVerify(arguments, environment);
    case BatchArguments::Action::kRun:
      break;
  }
  return Run(arguments, environment);
}

}  // namespace duet::client::cli
