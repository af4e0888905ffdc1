#include "server/lifecycle/run_server.h"

#include <sys/resource.h>

#include <cstdint>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "server/config/cpu_budget.h"
#include "server/config/load_config.h"
#include "server/lifecycle/duet_server.h"
#include "server/lifecycle/library_logs.h"
#include "server/metrics/queued_log_sink.h"
#include "server/metrics/text_log_sink.h"

namespace duet::server::lifecycle {
namespace {

// Each connection is a descriptor, and gRPC's listener does not come back from running out.
void RaiseDescriptorLimit() {
  rlimit limit = {};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

// The checkpoints linked into the program; the first is the default unless the operator says so.
absl::Status LoadEmbedded(const ModelSource& source, DuetServer& server) {
  const common::TimePoint begin = common::Clock::Real().Now();
  const auto models = source.load_embedded();
  const double seconds = common::SecondsBetween(begin, common::Clock::Real().Now());
  if (!models.ok()) {
    server.Add({"embedded", models.status(), seconds});
    return absl::OkStatus();
  }
  for (const std::shared_ptr<const engine::Synthesizer>& model : *models) {
    const engine::ModelDescription& description = model->description();
    server.Add({absl::StrCat("embedded/", description.name, "/", description.version), model,
                seconds / static_cast<double>(models->size())});
  }
  if (models->empty()) return absl::OkStatus();
  return server.SetDefault(models->front()->description().name);
}

// Loads what the options name, one after the other, until told to stop.
absl::Status LoadModels(const config::ServerOptions& options, const ModelSource& source,
                        StopSignal& stop, DuetServer& server) {
  if (options.model_repository.empty()) {
    return LoadEmbedded(source, server);
  }
  const absl::StatusOr<registry::RepositoryListing> listing =
      registry::ListCheckpoints(options.model_repository);
  if (!listing.ok()) return listing.status();
  for (const absl::Status& unreadable : listing->unreadable) {
    server.log().Error("folder_skipped", {{"message", std::string(unreadable.message())}});
  }
  for (const std::filesystem::path& folder : listing->checkpoints) {
    if (stop.WaitFor(0)) return absl::CancelledError("told to stop while loading");
    server.Add(registry::LoadCheckpoint(folder, source.load_folder));
  }
  return absl::OkStatus();
}

// Serves until told to stop; what it cannot serve for is in the log as well.
absl::Status Serve(const config::ServerOptions& options, const ModelSource& source,
                   StopSignal& stop, metrics::LogSink& sink) {
  metrics::JsonLog log(sink, absl::Now, LogOptionsOf(options.logging));
  const LibraryLogs library_logs(log);
  log.Info("engine_opened", {{"engine", source.engine}});
  absl::StatusOr<std::unique_ptr<DuetServer>> server = DuetServer::Start(options, sink);
  absl::Status status = server.status();
  if (status.ok()) status = LoadModels(options, source, stop, **server);
  if (absl::IsCancelled(status)) return absl::OkStatus();
  if (status.ok()) status = (*server)->Serve();
  if (!status.ok()) {
    log.Error("cannot_serve", {{"message", std::string(status.message())}});
    return status;
  }
  stop.Wait();
  (*server)->Drain([&stop](double seconds) { return !stop.WaitFor(seconds); });
  return absl::OkStatus();
}

}  // namespace

int RunServer(int argc, const char* const* argv, const EngineOpener& open_engine, StopSignal& stop,
              std::shared_ptr<metrics::LogSink> sink) {
  const absl::StatusOr<config::CommandLine> command_line = config::ParseCommandLine(argc, argv);
  if (command_line.ok() && command_line->print.has_value()) {
    std::cout << *command_line->print;
    return kExitStopped;
  }
  const absl::StatusOr<config::ServerOptions> options =
      command_line.ok() ? config::ToOptions(command_line->config, config::AvailableCores())
                        : absl::StatusOr<config::ServerOptions>(command_line.status());
  if (!options.ok()) {
    std::cerr << "duet-server: " << options.status().message() << "\n";
    return kExitUsage;
  }
  const absl::StatusOr<ModelSource> source = open_engine(options->engine);
  if (!source.ok()) {
    std::cerr << "duet-server: " << source.status().message() << "\n";
    return kExitUsage;
  }
  RaiseDescriptorLimit();
  metrics::QueuedLogSink::Options log;
  log.drop_notice = [](std::uint64_t dropped) { return metrics::DroppedLinesNotice(dropped); };
  if (options->logging.format == config::LoggingOptions::Format::kText) {
    sink = std::make_shared<metrics::TextLogSink>(std::move(sink));
  }
  // Outlives everything that logs, and writes its last lines before the process ends.
  metrics::QueuedLogSink queued_sink(std::move(sink), log);
  return Serve(*options, *source, stop, queued_sink).ok() ? kExitStopped : kExitFailed;
}

}  // namespace duet::server::lifecycle
