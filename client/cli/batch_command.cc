#include "client/cli/batch_command.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <mutex>
#include <ostream>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/batch/estimate.h"
#include "client/batch/job.h"
#include "client/batch/leader_source.h"
#include "client/batch/manifest.h"
#include "client/batch/merge.h"
#include "client/batch/plan.h"
#include "client/batch/setup.h"
#include "client/batch/verify.h"
#include "client/cli/batch_progress.h"
#include "client/cli/server_options.h"
#include "client/cli/stop_signals.h"
#include "client/model_skeleton.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

// The longest that a server is waited for before a run begins.
constexpr double kFirstAnswerSeconds = 10;

// A manifest's file, open as long as it is read.
class OpenManifest final : public batch::LeaderSource {
 public:
  explicit OpenManifest(const std::string& path)
      : file_(path),
        source_(batch::ReadManifest(file_, std::filesystem::path(path).parent_path(), path)) {}
  bool ok() const { return file_.is_open(); }
  absl::StatusOr<std::optional<batch::LeaderEntry>> Next() override { return source_->Next(); }

 private:
  std::ifstream file_;
  std::unique_ptr<batch::LeaderSource> source_;
};

absl::StatusOr<std::unique_ptr<batch::LeaderSource>> OpenLeaders(const BatchArguments& arguments,
                                                                 std::istream* in) {
  if (arguments.manifest.empty()) return batch::ListLeaders(arguments.leaders);
  if (arguments.manifest == "-") {
    if (in == nullptr) return absl::NotFoundError("--manifest -: there is no standard input");
    return batch::ReadManifest(*in, "", "-");
  }
  auto manifest = std::make_unique<OpenManifest>(arguments.manifest);
  if (!manifest->ok()) {
    return absl::NotFoundError(absl::StrCat(arguments.manifest, ": cannot be opened"));
  }
  return std::unique_ptr<batch::LeaderSource>(std::move(manifest));
}

absl::StatusOr<batch::Shard> ShardOf(const BatchArguments& arguments) {
  if (arguments.shard.has_value()) return *arguments.shard;
  return batch::ShardFromEnvironment([](const char* name) -> std::optional<std::string> {
    const char* value = std::getenv(name);
    if (value == nullptr) return std::nullopt;
    return std::string(value);
  });
}

// For each server the clients that take turns. Retries are the job's own, item by item.
absl::StatusOr<std::vector<std::vector<Client>>> Connect(const BatchArguments& arguments,
                                                         const ProgramEnvironment& environment) {
  std::vector<std::vector<Client>> servers;
  for (const std::string& address : arguments.servers) {
    ServerArguments server = arguments.connection;
    server.address = address;
    absl::StatusOr<ClientOptions> options = ToClientOptions(server);
    if (!options.ok()) return options.status();
    options->retry.max_attempts = 1;
    options->own_connection = arguments.channels > 1;
    servers.emplace_back();
    for (int i = 0; i < arguments.channels; ++i) {
      absl::StatusOr<Client> client = environment.connect(*options);
      if (!client.ok()) return client.status();
      servers.back().push_back(*std::move(client));
    }
  }
  return servers;
}

// The models, from the first server that answers.
absl::StatusOr<std::vector<ModelInfo>> AskModels(const BatchArguments& arguments,
                                                 const ProgramEnvironment& environment,
                                                 const batch::Recipe& recipe,
                                                 const std::vector<ModelChoice>& begun) {
  absl::Status status;
  for (const std::string& address : arguments.servers) {
    ServerArguments server = arguments.connection;
    server.address = address;
    absl::StatusOr<ClientOptions> options = ToClientOptions(server);
    if (!options.ok()) return options.status();
    options->deadline =
        absl::Seconds(std::max(0.1, std::min(arguments.patience_seconds, kFirstAnswerSeconds)));
    options->retry.max_attempts = 1000;
    const absl::StatusOr<Client> client = environment.connect(*options);
    if (!client.ok()) return client.status();
    absl::StatusOr<std::vector<ModelInfo>> models = ResolveModels(*client, recipe, begun);
    if (models.ok()) return models;
    status = models.status();
    if (!absl::IsUnavailable(status) && !absl::IsDeadlineExceeded(status)) break;
  }
  return status;
}

// Counts the items of a plan in a thread of its own, so that the time left can be told.
class Counting {
 public:
  Counting(absl::StatusOr<batch::Plan> plan, const batch::Shard& shard, int64_t limit) {
    if (!plan.ok()) return;
    thread_ = std::thread([this, shard, limit, plan = *std::move(plan)]() mutable {
      int64_t count = 0;
      for (int64_t i = 0; i < limit && !ended_; ++i) {
        const absl::StatusOr<std::optional<batch::Item>> item = plan.Next();
        if (!item.ok() || ended_) return;
        if (!item->has_value()) break;
        if (shard.Has((*item)->id)) ++count;
      }
      if (!ended_) total_ = count;
    });
  }
  Counting(const Counting&) = delete;
  Counting& operator=(const Counting&) = delete;
  ~Counting() {
    ended_ = true;
    if (thread_.joinable()) thread_.join();
  }
  const std::atomic<int64_t>& total() const { return total_; }

 private:
  std::atomic<bool> ended_{false};
  std::atomic<int64_t> total_{-1};
  std::thread thread_;
};

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

absl::StatusOr<batch::Plan> MakePlan(const BatchArguments& arguments, const batch::Recipe& recipe,
                                     const std::vector<ModelInfo>& models, std::istream* in) {
  absl::StatusOr<std::unique_ptr<batch::LeaderSource>> leaders = OpenLeaders(arguments, in);
  if (!leaders.ok()) return leaders.status();
  return batch::Plan::Create(recipe, models, *std::move(leaders));
}

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

void Report(const BatchArguments& arguments, const std::filesystem::path& folder,
            const batch::JobReport& report, const ProgramEnvironment& environment) {
  const int64_t settled = report.set.done + report.set.rejected + report.set.failed;
  if (arguments.json) {
    const nlohmann::ordered_json event = {{"event", "end"},
                                          {"folder", folder.string()},
                                          {"planned", report.planned},
                                          {"done", report.set.done},
                                          {"rejected", report.set.rejected},
                                          {"failed", report.set.failed},
                                          {"missing", report.planned - settled},
                                          {"bytes", report.set.bytes},
                                          {"stopped", std::string(report.stopped.message())}};
    *environment.out << event.dump() << "\n";
  } else if (!arguments.quiet) {
    *environment.out << folder.string() << ": " << report.set.done << " done, "
                     << report.set.rejected << " rejected, " << report.set.failed << " failed, "
                     << report.planned - settled << " missing\n";
  }
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

void ReportEstimate(const BatchArguments& arguments, const batch::Estimate& estimate,
                    const ProgramEnvironment& environment) {
  if (arguments.json) {
    const nlohmann::ordered_json event = {
        {"event", "estimate"},         {"items", estimate.items},
        {"leaders", estimate.leaders}, {"unreadable", estimate.unreadable},
        {"frames", estimate.frames},   {"seconds", estimate.seconds},
        {"bytes", estimate.bytes},     {"problems", estimate.problems}};
    *environment.out << event.dump() << "\n";
    return;
  }
  *environment.out << absl::StrFormat(
      "%d items of %d leaders, %d frames: about %.0f s of calls one after the other, %.1f MB\n",
      estimate.items, estimate.leaders, estimate.frames, estimate.seconds, estimate.bytes / 1e6);
  if (estimate.unreadable == 0) return;
  *environment.err << estimate.unreadable << " leaders cannot be read:\n";
  for (const std::string& problem : estimate.problems) *environment.err << "  " << problem << "\n";
}

absl::StatusOr<ExitCode> RunDry(const BatchArguments& arguments,
                                const ProgramEnvironment& environment, Prepared prepared) {
  const absl::StatusOr<batch::JobIdentity> begun =
      batch::ReadJobIdentity(ShardFolder(arguments.out, prepared.shard));
  absl::Status status = Prepare(arguments, environment,
                                begun.ok() ? begun->models : std::vector<ModelChoice>(), &prepared);
  if (!status.ok()) return status;
  absl::StatusOr<batch::Plan> plan =
      MakePlan(arguments, prepared.recipe, prepared.models, environment.in);
  if (!plan.ok()) return plan.status();
  const absl::StatusOr<batch::Estimate> estimate =
      EstimateJob(prepared.recipe, prepared.models, prepared.skeletons, prepared.shard,
                  arguments.limit, prepared.servers.front().front(), &*plan);
  if (!estimate.ok()) return estimate.status();
  ReportEstimate(arguments, *estimate, environment);
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
  absl::StatusOr<batch::Plan> plan =
      MakePlan(arguments, prepared.recipe, prepared.models, environment.in);
  if (!plan.ok()) return plan.status();
  const batch::JobIdentity identity = WithModels(wanted, prepared.models, prepared.skeletons);
  if (begun.models.empty()) status = folder.Begin(identity);
  if (!status.ok()) return status;
  // What a pipe brings can be read only once.
  const bool countable = arguments.manifest != "-" && arguments.share >= 1;
  const Counting counting(countable
                              ? MakePlan(arguments, prepared.recipe, prepared.models, nullptr)
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
  const bool complete = report->missing.empty();
  if (arguments.json) {
    const nlohmann::ordered_json object = {{"planned", report->planned},
                                           {"missing", report->missing}};
    *environment.out << object.dump() << "\n";
    return complete ? kExitDone : kExitRetry;
  }
  *environment.out << arguments.out.string() << ": " << report->planned << " items merged\n";
  if (complete) return kExitDone;
  *environment.err << "duet: no shard has items " << absl::StrJoin(report->missing, ", ")
                   << "; run their shards again\n";
  return kExitRetry;
}

absl::StatusOr<ExitCode> RunVerify(const BatchArguments& arguments,
                                   const ProgramEnvironment& environment) {
  const absl::StatusOr<batch::VerifyReport> report = batch::Verify(arguments.out);
  if (!report.ok()) return report.status();
  if (arguments.json) {
    const nlohmann::ordered_json object = {{"items", report->items},
                                           {"files", report->files},
                                           {"missing", report->missing},
                                           {"problem_count", report->problem_count},
                                           {"problems", report->problems}};
    *environment.out << object.dump() << "\n";
  } else {
    *environment.out << arguments.out.string() << ": " << report->items << " items, "
                     << report->files << " files, " << report->problem_count << " problems, "
                     << report->missing << " items missing\n";
    for (const std::string& problem : report->problems) *environment.err << problem << "\n";
  }
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
