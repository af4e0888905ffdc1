#include "server/lifecycle/run_server.h"

#include <google/protobuf/stubs/logging.h>
#include <grpc/support/log.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "absl/time/clock.h"
#include "server/common/listen_address.h"
#include "server/config/container_limits.h"
#include "server/lifecycle/duet_server.h"
#include "server/lifecycle/grpc_server.h"
#include "server/lifecycle/load_models.h"
#include "server/metrics/json_log.h"
#include "server/metrics/server_metrics.h"
#include "server/registry/model_manager.h"
#include "server/registry/model_registry.h"
#include "server/security/secret_files.h"

namespace duet::server::lifecycle {

namespace {

void Add(const absl::Status& status, std::vector<std::string>* mistakes) {
  for (absl::string_view line : absl::StrSplit(status.message(), '\n', absl::SkipEmpty())) {
    mistakes->emplace_back(line);
  }
}

void CheckSecrets(const v1::ServerConfig& settings, std::vector<std::string>* mistakes) {
  security::SecretFiles::Options secrets = SecretsOf(settings);
  // A certificate without a key is a mistake in the settings, and reported there.
  if (secrets.tls.key.empty()) secrets.tls.certificate.clear();
  Add(security::SecretFiles::Open(std::move(secrets)).status(), mistakes);
}

void CheckAddress(absl::string_view field, const std::string& setting,
                  std::vector<std::string>* mistakes) {
  const std::optional<common::ListenAddress> address = common::AddressOf(setting);
  if (!address.has_value()) return;
  const absl::Status bindable = common::CheckBindable(address->host, address->port);
  if (bindable.ok() || absl::IsAlreadyExists(bindable)) return;
  mistakes->push_back(absl::StrCat(field, ": ", bindable.message()));
}

}  // namespace

ValidatedSettings ValidateSettings(const config::CommandLine& command_line, int cores,
                                   std::uint64_t memory_bytes, const EngineOpener& open_engine) {
  config::Settings settings = config::ReadSettings(command_line, cores, memory_bytes);
  ValidatedSettings validated{std::move(settings.values),
                              absl::UnknownError("not opened"),
                              std::move(settings.mistakes),
                              {}};
  const v1::ServerConfig& values = validated.values;
  validated.source = open_engine(values);
  Add(validated.source.status(), &validated.setting_mistakes);
  CheckSecrets(values, &validated.resource_mistakes);
  CheckAddress("listen", values.listen(), &validated.resource_mistakes);
  CheckAddress("metrics_listen", values.metrics_listen(), &validated.resource_mistakes);
  CheckAddress("admin_listen", values.admin_listen(), &validated.resource_mistakes);
  return validated;
}

namespace {

// Writes the result of loading each model.
class Findings final : public registry::ModelObserver {
 public:
  explicit Findings(std::ostream& out) : out_(out) {}

  void Loaded(const registry::LoadReport& report, bool) override {
    if (report.model.ok()) {
      out_ << "ok: " << report.source << "\n";
    } else {
      Problem(report.source + ": " + std::string(report.model.status().message()));
    }
  }
  void Scanned(const std::vector<registry::SkippedFolder>& skipped) override {
    for (const registry::SkippedFolder& folder : skipped) {
      Problem(folder.folder + ": skipped: " + folder.reason);
    }
  }

  void Problem(const std::string& problem) {
    for (absl::string_view line : absl::StrSplit(problem, '\n')) out_ << "wrong: " << line << "\n";
    all_right_ = false;
  }
  void Problems(const std::vector<std::string>& problems) {
    for (const std::string& problem : problems) Problem(problem);
  }
  void Problems(const absl::StatusOr<std::vector<std::string>>& problems) {
    if (!problems.ok()) return Problem(std::string(problems.status().message()));
    Problems(*problems);
  }
  bool all_right() const { return all_right_; }

 private:
  std::ostream& out_;
  bool all_right_ = true;
};

void CheckModels(const v1::ServerConfig& values, const registry::ModelSource& source,
                 Findings& findings, std::ostream& out) {
  registry::ModelRegistry registry;
  registry::ModelManager manager(registry, findings);
  ConfigureModels(values, manager);
  const auto loaded = LoadModels(
      values, source, [] { return false; }, manager, registry);
  if (loaded.ok()) {
    findings.Problems(*loaded);
    findings.Problems(SettleModels(values, manager, registry));
  } else {
    findings.Problem(std::string(loaded.status().message()));
  }
  for (const std::string& warning :
       config::MemoryWarnings(values, config::AvailableMemory(), metrics::ResidentBytes())) {
    out << "warning: " << warning << "\n";
  }
}

}  // namespace

int CheckConfig(const ValidatedSettings& settings, std::ostream& out) {
  Findings findings(out);
  findings.Problems(settings.setting_mistakes);
  findings.Problems(settings.resource_mistakes);
  if (settings.source.ok()) CheckModels(settings.values, *settings.source, findings, out);
  if (!settings.setting_mistakes.empty()) return kExitUsage;
  return findings.all_right() ? kExitStopped : kExitFailed;
}

namespace {

// Reports the state of the process to systemd, or to another service manager that has set
// NOTIFY_SOCKET. Does nothing without that variable.
//
// Source:  sd_notify(3): a datagram of lines to a Unix socket, which is abstract if its name begins
//          with '@'.
void NotifySystemd(const std::string& message) {
  const char* const variable = std::getenv("NOTIFY_SOCKET");
  const std::string path = variable == nullptr ? "" : variable;
  sockaddr_un address = {};
  if (path.empty() || path.size() >= sizeof(address.sun_path)) return;
  address.sun_family = AF_UNIX;
  std::copy(path.begin(), path.end(), address.sun_path);
  if (path[0] == '@') address.sun_path[0] = '\0';
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size());
  const int descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return;
  sendto(descriptor, message.data(), message.size(), MSG_NOSIGNAL,
         reinterpret_cast<const sockaddr*>(&address), length);
  close(descriptor);
}

// The time, of CLOCK_MONOTONIC, lets systemd match a READY=1 with one of several reloads.
void NotifyReloading() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  NotifySystemd(absl::StrCat("RELOADING=1\nMONOTONIC_USEC=",
                             std::chrono::duration_cast<std::chrono::microseconds>(now).count()));
}

// The libraries accept only plain functions.
std::atomic<metrics::JsonLog*> current_log{nullptr};

void LogLibrary(const char* library, bool error, const std::string& message) {
  metrics::JsonLog* log = current_log.load(std::memory_order_acquire);
  if (log == nullptr) return;
  log->Library(library, error ? metrics::Severity::kError : metrics::Severity::kInfo, message);
}

void LogGrpc(gpr_log_func_args* args) {
  LogLibrary("grpc", args->severity == GPR_LOG_SEVERITY_ERROR, args->message);
}

void LogProtobuf(google::protobuf::LogLevel level, const char*, int, const std::string& message) {
  // A malformed request is the caller's error, not the server's.
  LogLibrary("protobuf", level == google::protobuf::LOGLEVEL_FATAL, message);
}

// Writes the messages of gRPC and Protobuf to the log as JSON while it exists, so that every line
// of the server's output parses.
//
// Threads: construct it before gRPC starts; at most one exists at a time.
class LibraryLogs {
 public:
  // `log` outlives it.
  explicit LibraryLogs(metrics::JsonLog& log) {
    current_log.store(&log, std::memory_order_release);
    gpr_set_log_function(LogGrpc);
    google::protobuf::SetLogHandler(LogProtobuf);
  }
  ~LibraryLogs() {
    google::protobuf::SetLogHandler(nullptr);
    gpr_set_log_function(nullptr);
    current_log.store(nullptr, std::memory_order_release);
  }
  LibraryLogs(const LibraryLogs&) = delete;
  LibraryLogs& operator=(const LibraryLogs&) = delete;
};

// Each connection needs a descriptor, and gRPC's listener does not recover from running out.
void RaiseDescriptorLimit() {
  rlimit limit = {};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

// Resolves the settings again: flags and variables stay, the file may have changed.
using ReadSettings = std::function<absl::StatusOr<v1::ServerConfig>()>;

// Less than the image's HEALTHCHECK waits.
constexpr double kHealthSeconds = 4;

// Listens, loads and begins to serve. Fails with CANCELLED if a signal to stop arrives before that.
absl::StatusOr<std::unique_ptr<DuetServer>> StartServing(const v1::ServerConfig& values,
                                                         const ModelSource& source,
                                                         StopSignal& stop, metrics::LogSink& sink) {
  absl::StatusOr<std::unique_ptr<DuetServer>> server = DuetServer::Start(values, sink);
  if (!server.ok()) return server;
  absl::Status status = (*server)->Load(source, [&stop] { return stop.WaitFor(0); });
  if (status.ok()) status = (*server)->Serve();
  if (!status.ok()) return status;
  return server;
}

void NotifyReady(DuetServer& server) {
  const std::vector<registry::ModelStatus> models = server.control().List();
  const auto served = std::count_if(models.begin(), models.end(), [](const auto& model) {
    return model.state == registry::ModelState::kServed;
  });
  NotifySystemd(absl::StrCat("READY=1\nSTATUS=serving ", served, " models"));
}

// Serves until a signal to stop, and reloads at a signal to reload.
void ServeUntilStopped(DuetServer& server, StopSignal& stop) {
  NotifyReady(server);
  while (stop.Wait() == StopSignal::Kind::kReload) {
    NotifyReloading();
    server.control().Reload([&server](const auto& report) {
      if (!absl::IsCancelled(report.status())) NotifyReady(server);
    });
  }
  NotifySystemd("STOPPING=1");
  server.Drain([&stop](double seconds) { return !stop.WaitFor(seconds); });
}

// Called after the models are loaded, because their size is not known before.
void WarnOfMemory(const v1::ServerConfig& values, metrics::JsonLog& log) {
  for (const std::string& warning :
       config::MemoryWarnings(values, config::AvailableMemory(), metrics::ResidentBytes())) {
    log.Warning("settings_do_not_fit", {{"message", warning}});
  }
}

// Serves until a signal to stop. If it cannot serve, it logs the reason.
absl::Status Serve(const ValidatedSettings& settings, const ReadSettings& read_settings,
                   StopSignal& stop, metrics::LogSink& sink) {
  const v1::ServerConfig& values = settings.values;
  const ModelSource& source = *settings.source;
  metrics::JsonLog log(sink, absl::Now, LogOptionsOf(values));
  const LibraryLogs library_logs(log);
  for (const std::string& mistake : settings.resource_mistakes) {
    log.Error("cannot_serve", {{"message", mistake}});
  }
  if (!settings.resource_mistakes.empty()) {
    return absl::FailedPreconditionError(settings.resource_mistakes.front());
  }
  log.Info("engine_opened", {{"engine", source.engine}});
  const auto server = StartServing(values, source, stop, sink);
  if (absl::IsCancelled(server.status())) return absl::OkStatus();
  if (!server.ok()) {
    log.Error("cannot_serve", {{"message", std::string(server.status().message())}});
    return server.status();
  }
  WarnOfMemory(values, log);
  stop.AllowToStop(values.drain_seconds() + values.grace_seconds() + StopSignal::kHurrySeconds);
  DuetServer& serving = **server;
  const auto configure = [&serving, &read_settings] {
    const absl::StatusOr<v1::ServerConfig> current = read_settings();
    if (current.ok()) serving.Configure(*current);
    return current.status();
  };
  serving.control().AddReloadable({"configuration", configure});
  ServeUntilStopped(serving, stop);
  return absl::OkStatus();
}

void Complain(const std::vector<std::string>& mistakes) {
  for (const std::string& mistake : mistakes) std::cerr << "duet-server: " << mistake << "\n";
}

int ReportHealth(const v1::ServerConfig& values) {
  const absl::Status health = CheckHealth(values, kHealthSeconds);
  if (health.ok()) return kExitStopped;
  Complain({std::string(health.message())});
  return kExitFailed;
}

}  // namespace

int RunServer(int argc, const char* const* argv, const EngineOpener& open_engine, StopSignal& stop,
              std::shared_ptr<metrics::LogSink> sink) {
  const auto read = [argc, argv] {
    return config::ParseCommandLine(argc, argv, config::ReadEnvironment(environ));
  };
  const config::CommandLine command_line = read();
  if (command_line.print.has_value()) {
    std::cout << *command_line.print;
    return kExitStopped;
  }
  const int cores = config::AvailableCores();
  const std::uint64_t memory = config::AvailableMemory();
  if (command_line.task == config::Task::kPrintConfig ||
      command_line.task == config::Task::kCheckHealth) {
    const config::Settings settings = config::ReadSettings(command_line, cores, memory);
    Complain(settings.mistakes);
    if (!settings.mistakes.empty()) return kExitUsage;
    if (command_line.task == config::Task::kCheckHealth) {
      return ReportHealth(settings.values);
    }
    std::cout << config::PrintConfig(settings.values, command_line.sources);
    return kExitStopped;
  }
  const ValidatedSettings settings = ValidateSettings(command_line, cores, memory, open_engine);
  if (command_line.task == config::Task::kCheckConfig) {
    stop.Release();
    return CheckConfig(settings, std::cout);
  }
  if (!settings.setting_mistakes.empty()) {
    Complain(settings.setting_mistakes);
    Complain(settings.resource_mistakes);
    return kExitUsage;
  }
  RaiseDescriptorLimit();
  // If the reader of the log exits, log lines are lost, but no call is.
  std::signal(SIGPIPE, SIG_IGN);
  // Outlives everything that logs, and writes the last lines before the process exits.
  metrics::QueuedLogSink queued_sink(std::move(sink));
  const auto read_settings = [&] { return config::ResolveSettings(read(), cores, memory); };
  return Serve(settings, read_settings, stop, queued_sink).ok() ? kExitStopped : kExitFailed;
}

}  // namespace duet::server::lifecycle
