#include "server/lifecycle/duet_server.h"

#include <grpcpp/health_check_service_interface.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "server/batching/window_queue.h"
#include "server/common/listen_address.h"
#include "server/security/secret_files.h"
#include "server/service/refusals.h"

namespace duet::server::lifecycle {
namespace {

// Timeout for the readers of aborted calls to read the current message, which is sent before the
// status.
constexpr double kLastMessageSeconds = 3;
// Timeout for gRPC to send the statuses of aborted calls.
constexpr std::chrono::seconds kFlush(1);
// Interval for noticing changed files and for reporting calls that were not logged.
constexpr double kHousekeepingSeconds = 1;
// Interval at which a drain checks for the last call and for a second signal.
constexpr double kLookSeconds = 0.05;
// Interval at which the service checks the duration of its calls. It is short so that a request
// that arrives slowly is noticed before much of it has arrived.
constexpr double kCheckTimeSeconds = 0.02;
// So many failed self-checks in a row make the server unhealthy: a restart would help.
constexpr int kUnhealthy = 3;
// Timeout of a self-check.
constexpr double kSelfCheckTimeoutSeconds = 5;
// A batch takes milliseconds: workers that finish none for this long while windows wait hang.
constexpr double kQueueStuckSeconds = 10;
// Interval for returning the memory of large requests.
constexpr double kTrimSeconds = 1;

// Limits of the admin service, far above what an operator needs.
constexpr std::size_t kAdminRequestBytes = std::size_t{64} << 10;
constexpr std::size_t kAdminTransportBytes = std::size_t{16} << 20;
constexpr int kAdminCalls = 32;

batching::BatcherOptions Batching(const v1::ServerConfig& settings) {
  return {static_cast<int>(settings.workers()),
          static_cast<int>(settings.max_queued_windows()),
          {static_cast<int>(settings.max_batch_windows()),
           common::Seconds(settings.max_batch_delay_seconds())},
          settings.client_share()};
}

service::AdmissionLimits AdmissionOf(const v1::ServerConfig& settings) {
  service::AdmissionLimits limits;
  limits.max_calls = settings.max_calls();
  limits.max_held_bytes = settings.max_held_bytes();
  limits.max_slow_requests = settings.max_slow_requests();
  limits.client_share = settings.client_share();
  return limits;
}

// Nothing if the model decides.
std::optional<bool> CleanUpOf(const v1::ServerConfig& settings) {
  if (settings.clean_up() == v1::CLEAN_UP_POLICY_AUTO) return std::nullopt;
  return settings.clean_up() == v1::CLEAN_UP_POLICY_ON;
}

common::ListenAddress ListenAddressOf(const v1::ServerConfig& settings) {
  return common::AddressOf(settings.listen()).value_or(common::ListenAddress());
}

absl::Status OfSetting(absl::string_view setting, const absl::Status& status) {
  return absl::Status(status.code(), absl::StrCat(setting, ": ", status.message()));
}

}  // namespace

metrics::LogOptions LogOptionsOf(const v1::ServerConfig& settings) {
  metrics::LogOptions log;
  log.level = settings.log_level() == v1::LOG_LEVEL_ERROR     ? metrics::Severity::kError
              : settings.log_level() == v1::LOG_LEVEL_WARNING ? metrics::Severity::kWarning
                                                              : metrics::Severity::kInfo;
  log.refusals_per_second = static_cast<int>(settings.log_refusals_per_second());
  return log;
}

absl::StatusOr<std::unique_ptr<DuetServer>> DuetServer::Start(
    const v1::ServerConfig& settings, metrics::LogSink& sink,
    std::function<absl::Status()> self_check) {
  absl::StatusOr<std::unique_ptr<security::SecretFiles>> secrets =
      security::SecretFiles::Open(SecretsOf(settings));
  if (!secrets.ok()) return secrets.status();
  std::unique_ptr<DuetServer> server(new DuetServer(settings, sink, *std::move(secrets)));
  const absl::Status listening = server->Listen(std::move(self_check));
  if (!listening.ok()) return listening;
  return server;
}

DuetServer::DuetServer(const v1::ServerConfig& settings, metrics::LogSink& sink,
                       std::unique_ptr<security::SecretFiles> secrets)
    : settings_(settings),
      log_(sink, absl::Now, LogOptionsOf(settings)),
      secrets_(std::move(secrets)),
      events_(log_, metrics_, [this] { UpdateHealth(); }),
      manager_(registry_, events_),
      admission_(AdmissionOf(settings)),
      transport_(settings.max_transport_bytes()),
      scheduler_(batching::MakeBatcher(Batching(settings), common::Clock::Real(), &metrics_)),
      service_(Parts()),
      control_(manager_, events_),
      admin_(AdminParts()) {
  Configure(settings);
  control_.AddReloadable({"certificates and access file", [this] { return ReloadSecrets(); },
                          [this] { return secrets_->state(); }});
  metrics_.Describe(DUET_VERSION, settings_.max_calls(), settings_.max_queued_windows(),
                    settings_.workers());
  metrics_.SetRead(ReadValues(sink));
}

metrics::ReadValues DuetServer::ReadValues(const metrics::LogSink& sink) const {
  metrics::ReadValues read;
  read.queued_windows = [this] { return static_cast<double>(scheduler_->queued_windows()); };
  read.places_in_use = [this] { return static_cast<double>(admission_.calls()); };
  read.dropped_log_lines = [&sink] { return static_cast<double>(sink.dropped_lines()); };
  read.ready = [this] { return Ready(); };
  read.models = [this] { return registry_.List(); };
  if (secrets_->certificates() != nullptr) {
    read.certificate_end = [this] {
      return static_cast<double>(absl::ToUnixSeconds(secrets_->certificate_end()));
    };
  }
  return read;
}

DuetServer::~DuetServer() {
  // Loading uses every other member, and admin calls wait for it.
  control_.Stop();
  if (admin_grpc_.server != nullptr) {
    admin_grpc_.server->Shutdown(std::chrono::system_clock::now() + kFlush);
  }
  endpoint_.reset();
  self_check_.reset();
  if (grpc_.server != nullptr) Close();
  watch_.clear();
}

service::ServiceParts DuetServer::Parts() {
  service::ServiceParts parts;
  parts.registry = &registry_;
  parts.scheduler = scheduler_.get();
  parts.admission = &admission_;
  parts.transport = &transport_;
  parts.observers = {&metrics_, &log_};
  parts.access = secrets_->access();
  parts.limits.max_request_bytes = settings_.max_request_bytes();
  parts.reception.timeout_seconds = settings_.receive_timeout_seconds();
  parts.buffered_frames = static_cast<int>(settings_.buffered_frames());
  parts.write_timeout_seconds = settings_.write_timeout_seconds();
  parts.max_call_seconds = settings_.max_call_seconds();
  parts.live_idle_seconds = settings_.live_idle_seconds();
  parts.client_key = settings_.client_key();
  parts.clean_up = CleanUpOf(settings_);
  parts.engine = &engine_;
  parts.version = DUET_VERSION;
  return parts;
}

admin::AdminParts DuetServer::AdminParts() {
  admin::AdminParts parts;
  parts.control = &control_;
  parts.registry = &registry_;
  parts.admission = &admission_;
  parts.log = &log_;
  parts.observers = {&metrics_};
  parts.access = secrets_->access();
  return parts;
}

absl::Status DuetServer::ListenForAdmin() {
  const std::optional<common::ListenAddress> address = common::AddressOf(settings_.admin_listen());
  if (!address.has_value()) return absl::OkStatus();
  GrpcServerOptions options;
  options.listen = *address;
  options.reflection = settings_.reflection();
  options.max_request_bytes = kAdminRequestBytes;
  options.max_transport_bytes = kAdminTransportBytes;
  options.max_calls = kAdminCalls;
  options.credentials = Credentials();
  absl::StatusOr<GrpcServer> started = StartGrpcServer(options, admin_);
  if (!started.ok()) return OfSetting("admin_listen", started.status());
  admin_grpc_ = *std::move(started);
  return absl::OkStatus();
}

absl::Status DuetServer::Listen(std::function<absl::Status()> self_check) {
  GrpcServerOptions options;
  options.listen = ListenAddressOf(settings_);
  options.reflection = settings_.reflection();
  options.max_request_bytes = settings_.max_request_bytes();
  options.max_transport_bytes = settings_.max_transport_bytes();
  options.max_calls = static_cast<int>(settings_.max_calls());
  options.credentials = Credentials();
  options.quota = &transport_.quota();
  absl::StatusOr<GrpcServer> grpc = StartGrpcServer(options, service_);
  if (!grpc.ok()) return OfSetting("listen", grpc.status());
  grpc_ = *std::move(grpc);
  SetHealth(false);
  if (absl::Status admin = ListenForAdmin(); !admin.ok()) return admin;
  Watch(std::move(self_check));
  const std::optional<common::ListenAddress> metrics =
      common::AddressOf(settings_.metrics_listen());
  if (!metrics.has_value()) return absl::OkStatus();
  metrics::MetricsEndpointOptions endpoint;
  endpoint.host = metrics->host;
  endpoint.port = metrics->port;
  endpoint.render = [this] { return metrics_.Render(); };
  endpoint.healthy = [this] { return failed_checks_ < kUnhealthy; };
  endpoint.ready = [this] { return Ready(); };
  absl::StatusOr<std::unique_ptr<metrics::MetricsEndpoint>> started =
      metrics::MetricsEndpoint::Start(std::move(endpoint));
  if (!started.ok()) return OfSetting("metrics_listen", started.status());
  endpoint_ = *std::move(started);
  return absl::OkStatus();
}

std::shared_ptr<grpc::ServerCredentials> DuetServer::Credentials() const {
  if (secrets_->certificates() == nullptr) return nullptr;
  return security::MakeServerCredentials(*secrets_->certificates());
}

void DuetServer::Tell(const std::vector<security::Reload>& reloads) {
  for (const security::Reload& reload : reloads) {
    metrics_.SecretsReloaded(std::string(reload.kind), reload.status.ok());
    if (reload.status.ok()) {
      log_.Info("secrets_reloaded", {{"kind", reload.kind}});
    } else {
      log_.Error("secrets_refused",
                 {{"kind", reload.kind}, {"message", std::string(reload.status.message())}});
    }
  }
}

absl::Status DuetServer::ReloadSecrets() {
  Tell(secrets_->Refresh());
  return secrets_->state();
}

void DuetServer::Watch(std::function<absl::Status()> self_check) {
  watch_.push_back(
      std::make_unique<common::RepeatedTask>(kCheckTimeSeconds, [this] { service_.CheckTime(); }));
  watch_.push_back(std::make_unique<common::RepeatedTask>(kTrimSeconds, [this] {
    heap_trimmer_.Look(service_.large_request_bytes(), admission_.held_bytes());
  }));
  watch_.push_back(std::make_unique<common::RepeatedTask>(kHousekeepingSeconds, [this] {
    Tell(secrets_->Look());
    log_.TellUnlogged();
  }));
  if (settings_.self_check_seconds() <= 0) return;
  if (settings_.watchdog_seconds() > 0) {
    stuck_ = std::make_unique<LastResort>(
        "stuck", "no self-check succeeded for watchdog_seconds; the process ends to be restarted",
        kExitStuck);
    stuck_->Set(settings_.self_check_seconds() + settings_.watchdog_seconds());
  }
  if (self_check == nullptr) {
    self_check = [this] { return CheckItself(); };
  }
  self_check_ = std::make_unique<common::RepeatedTask>(
      settings_.self_check_seconds(), [this, check = std::move(self_check)] { Checked(check()); });
}

void DuetServer::Checked(const absl::Status& status) {
  const bool changed = status.ok() != (failed_checks_ == 0);
  failed_checks_ = status.ok() ? 0 : failed_checks_ + 1;
  if (!status.ok()) {
    metrics_.SelfCheckFailed();
    log_.Error("self_check_failed", {{"message", std::string(status.message())}});
  } else if (stuck_ != nullptr) {
    stuck_->Set(settings_.self_check_seconds() + settings_.watchdog_seconds());
  }
  if (!changed) return;
  if (status.ok()) log_.Info("self_check_recovered", {});
  UpdateHealth();
}

absl::Status DuetServer::CheckItself() {
  const absl::Status listens =
      CheckListener(ListenAddressOf(settings_).host, grpc_.port, kSelfCheckTimeoutSeconds);
  if (!listens.ok()) return listens;
  const absl::Status answers = CheckAnswers(*grpc_.server, kSelfCheckTimeoutSeconds);
  if (!answers.ok()) return answers;
  const std::uint64_t batches = metrics_.batches();
  const common::TimePoint now = common::Clock::Real().Now();
  if (scheduler_->queued_windows() == 0 || batches != seen_batches_) queue_moved_ = now;
  seen_batches_ = batches;
  if (common::SecondsBetween(queue_moved_, now) < kQueueStuckSeconds) return absl::OkStatus();
  return absl::UnavailableError("windows wait, and no worker finishes a batch");
}

bool DuetServer::Ready() const { return serving_ && failed_checks_ == 0; }

void DuetServer::Configure(const v1::ServerConfig& settings) {
  ConfigureModels(settings, manager_);
}

absl::Status DuetServer::Load(const registry::ModelSource& source,
                              const std::function<bool()>& stop) {
  engine_ = source.engine;
  const absl::StatusOr<std::vector<std::string>> problems =
      LoadModels(settings_, source, stop, manager_, registry_);
  if (!problems.ok()) return problems.status();
  for (const std::string& problem : *problems) {
    log_.Error("load_problem", {{"message", problem}});
  }
  return absl::OkStatus();
}

absl::Status DuetServer::Serve() {
  const absl::StatusOr<std::vector<std::string>> refused_labels =
      SettleModels(settings_, manager_, registry_);
  if (!refused_labels.ok()) return refused_labels.status();
  for (const std::string& label : *refused_labels) {
    log_.Error("version_label_refused", {{"message", label}});
  }
  admission_.SetState(service::Admission::State::kServing);
  SetHealth(true);
  log_.Info("serving", {{"port", port()},
                        {"metrics_port", metrics_port()},
                        {"admin_port", admin_port()},
                        {"workers", settings_.workers()},
                        {"max_batch_windows", settings_.max_batch_windows()}});
  return absl::OkStatus();
}

void DuetServer::Drain(const std::function<bool(double seconds)>& wait) {
  SetHealth(false);  // from here on the server reports that it is not ready
  control_.Stop();
  log_.Info("draining", {{"calls", admission_.calls()}});
  bool patient = settings_.drain_seconds() <= 0 || wait(settings_.drain_seconds());
  // From here on new calls are rejected with UNAVAILABLE. gRPC's Shutdown comes last, because it
  // also waits for health watches, which never end by themselves.
  admission_.SetState(service::Admission::State::kDraining);
  service_.AnnounceDrain();
  double left = settings_.grace_seconds();
  while (patient && left > 0 && admission_.calls() > 0) {
    const double step = std::min(left, kLookSeconds);
    patient = wait(step);
    left -= step;
  }
  const std::size_t aborted = admission_.calls();
  Close();
  log_.Info("stopped", {{"aborted_calls", aborted}});
}

void DuetServer::Close() {
  admission_.SetState(service::Admission::State::kDraining);
  service_.AbortAll(service::DrainingRefusal());
  // Shutdown's deadline would end the rest as CANCELLED, without a message.
  service_.FinishAborted(kLastMessageSeconds);
  // gRPC 1.51 crashes if a call within the process begins while the server shuts down.
  self_check_.reset();
  if (stuck_ != nullptr) stuck_->Set(0);
  grpc_.server->Shutdown(std::chrono::system_clock::now() + kFlush);
}

void DuetServer::SetHealth(bool serving) {
  serving_ = serving;
  UpdateHealth();
}

void DuetServer::UpdateHealth() {
  common::MutexLock lock(health_mutex_);
  grpc::HealthCheckServiceInterface* health = grpc_.server->GetHealthCheckService();
  const std::string service = service::MotionSynthesisService::kServiceName;
  const bool healthy = Ready();
  health->SetServingStatus("", healthy);
  health->SetServingStatus(service, healthy);
  std::set<std::string> served;
  for (const registry::ServedModel& model : registry_.List()) {
    served.insert(model.model->description().name);
  }
  health_models_.insert(served.begin(), served.end());
  for (const std::string& model : health_models_) {
    const bool serving = healthy && served.count(model) > 0;
    health->SetServingStatus(absl::StrCat(service, "/", model), serving);
  }
}

}  // namespace duet::server::lifecycle
