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
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "absl/time/clock.h"
#include "server/config/container_limits.h"
#include "server/config/load_config.h"
#include "server/config/memory_plan.h"
#include "server/lifecycle/duet_server.h"
#include "server/lifecycle/process_end.h"
#include "server/lifecycle/self_check.h"
#include "server/lifecycle/validate_settings.h"
#include "server/metrics/json_log.h"
#include "server/metrics/log_sink.h"
#include "server/metrics/process_metrics.h"

namespace duet::server::lifecycle {

namespace {

// Reports the state of the process to systemd, or to another service manager that has set
// NOTIFY_SOCKET. Does nothing without that variable.
//
// Source:  sd_notify(3): a datagram of lines to a Unix socket, which is abstract if its name begins
//          with '@'.
// Threads: safe to call concurrently.
class SystemdNotifier {
 public:
  // `socket`: the value of NOTIFY_SOCKET; may be empty.
  explicit SystemdNotifier(std::string socket) : socket_(std::move(socket)) {}
  // Uses NOTIFY_SOCKET of this process.
  static SystemdNotifier OfProcess();

  // Calls are served. `status` is a line for people.
  void Ready(absl::string_view status) const;
  // A reload has begun. Ready ends it.
  void Reloading() const;
  void Stopping() const;

 private:
  void Send(const std::string& message) const;

  const std::string socket_;
};

SystemdNotifier SystemdNotifier::OfProcess() {
  const char* socket = std::getenv("NOTIFY_SOCKET");
  return SystemdNotifier(socket == nullptr ? "" : socket);
}

void SystemdNotifier::Ready(absl::string_view status) const {
  Send(absl::StrCat("READY=1\nSTATUS=", status));
}

void SystemdNotifier::Reloading() const {
  // The time, of CLOCK_MONOTONIC, lets systemd match a READY=1 with one of several reloads.
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  Send(absl::StrCat("RELOADING=1\nMONOTONIC_USEC=",
                    std::chrono::duration_cast<std::chrono::microseconds>(now).count()));
}

void SystemdNotifier::Stopping() const { Send("STOPPING=1"); }

void SystemdNotifier::Send(const std::string& message) const {
  sockaddr_un address = {};
  if (socket_.empty() || socket_.size() >= sizeof(address.sun_path)) return;
  address.sun_family = AF_UNIX;
  std::copy(socket_.begin(), socket_.end(), address.sun_path);
  if (socket_[0] == '@') address.sun_path[0] = '\0';
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket_.size());
  const int descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return;
  sendto(descriptor, message.data(), message.size(), MSG_NOSIGNAL,
         reinterpret_cast<const sockaddr*>(&address), length);
  close(descriptor);
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

// The number of served models, for the status line of systemd.
std::string ServedText(DuetServer& server) {
  const std::vector<registry::ModelStatus> models = server.control().List();
  const auto served = std::count_if(models.begin(), models.end(), [](const auto& model) {
    return model.state == registry::ModelState::kServed;
  });
  const auto outdated =
      std::count_if(models.begin(), models.end(), [](const auto& model) { return model.outdated; });
  return absl::StrCat("serving ", served, " models",
                      outdated == 0 ? "" : absl::StrCat(", ", outdated, " of them outdated"));
}

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

// Serves until a signal to stop, and reloads at a signal to reload.
void ServeUntilStopped(DuetServer& server, StopSignal& stop, const SystemdNotifier& systemd) {
  systemd.Ready(ServedText(server));
  while (stop.Wait() == StopSignal::Kind::kReload) {
    systemd.Reloading();
    server.control().Reload([&server, &systemd](const auto& report) {
      if (!absl::IsCancelled(report.status())) systemd.Ready(ServedText(server));
    });
  }
  systemd.Stopping();
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
  const SystemdNotifier systemd = SystemdNotifier::OfProcess();
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
  ServeUntilStopped(serving, stop, systemd);
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
    return config::ParseCommandLine(argc, argv, config::ProcessEnvironment());
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
  const bool check = command_line.task == config::Task::kCheckConfig;
  const ValidatedSettings settings = ValidateSettings(command_line, cores, memory, open_engine,
                                                      check ? Ports::kMayBeInUse : Ports::kFree);
  if (check) {
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
  metrics::QueuedLogSink::Options log;
  log.drop_notice = [](std::uint64_t dropped) { return metrics::DroppedLinesNotice(dropped); };
  // Outlives everything that logs, and writes the last lines before the process exits.
  metrics::QueuedLogSink queued_sink(std::move(sink), log);
  const auto read_settings = [&] { return config::ResolveSettings(read(), cores, memory); };
  return Serve(settings, read_settings, stop, queued_sink).ok() ? kExitStopped : kExitFailed;
}

}  // namespace duet::server::lifecycle
