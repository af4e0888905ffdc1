#include "server/lifecycle/duet_server.h"

#include <grpcpp/health_check_service_interface.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "server/batching/batcher.h"
#include "server/security/server_credentials.h"
#include "server/service/refusals.h"

namespace duet::server::lifecycle {
namespace {

// How long gRPC may take to hand out the statuses of calls that were ended.
constexpr std::chrono::seconds kFlush(1);
// How soon a file that changed is noticed, and how often calls without a line are told of.
constexpr double kHousekeepingSeconds = 1;
// How often a drain looks whether the last call has finished or a second signal has come, and the
// service at the time that its calls take.
constexpr double kLookSeconds = 0.05;
// How often memory of large requests is given back.
constexpr double kTrimSeconds = 1;

service::RequestLimits Limits(const config::ServerOptions& options) {
  service::RequestLimits limits;
  limits.max_request_bytes = options.max_request_bytes;
  return limits;
}

batching::BatcherOptions Batching(const config::ServerOptions& options) {
  const std::chrono::duration<double> delay(options.max_batch_delay_seconds);
  return {options.workers,
          options.max_queued_windows,
          {options.max_batch_windows, std::chrono::duration_cast<std::chrono::nanoseconds>(delay)},
          options.client_share};
}

service::AdmissionLimits AdmissionOf(const config::ServerOptions& options) {
  service::AdmissionLimits limits;
  limits.max_calls = static_cast<std::size_t>(options.max_calls);
  limits.max_held_bytes = options.max_held_bytes;
  limits.max_slow_requests = static_cast<std::size_t>(options.max_slow_requests);
  limits.client_share = options.client_share;
  return limits;
}

security::SecretFiles::Options Secrets(const config::SecurityOptions& options) {
  security::SecretFiles::Options secrets;
  secrets.tls = {options.tls_certificate_file, options.tls_key_file, options.tls_client_ca_file};
  secrets.access = options.access_file;
  return secrets;
}

std::vector<metrics::ServedVersion> Served(const registry::ModelRegistry& registry) {
  std::vector<metrics::ServedVersion> served;
  for (const registry::ServedModel& model : registry.List()) {
    const engine::ModelDescription& description = model.model->description();
    served.push_back({description.name, description.version, model.is_default});
  }
  return served;
}

}  // namespace

metrics::LogOptions LogOptionsOf(const config::LoggingOptions& options) {
  using Level = config::LoggingOptions::Level;
  metrics::LogOptions log;
  log.level = options.level == Level::kError     ? metrics::Severity::kError
              : options.level == Level::kWarning ? metrics::Severity::kWarning
                                                 : metrics::Severity::kInfo;
  log.success_ratio = options.success_ratio;
  log.refusals_per_second = options.refusals_per_second;
  return log;
}

absl::StatusOr<std::unique_ptr<DuetServer>> DuetServer::Start(const config::ServerOptions& options,
                                                              metrics::LogSink& sink) {
  absl::StatusOr<std::unique_ptr<security::SecretFiles>> secrets =
      security::SecretFiles::Open(Secrets(options.security));
  if (!secrets.ok()) return secrets.status();
  std::unique_ptr<tracing::CallTracer> tracer;
  if (!options.tracing.otlp_endpoint.empty()) {
    auto opened = tracing::CallTracer::Open(options.tracing.otlp_endpoint, DUET_VERSION);
    if (!opened.ok()) return opened.status();
    tracer = *std::move(opened);
  }
  std::unique_ptr<DuetServer> server(
      new DuetServer(options, sink, *std::move(secrets), std::move(tracer)));
  const absl::Status listening = server->Listen();
  if (!listening.ok()) return listening;
  return server;
}

DuetServer::DuetServer(const config::ServerOptions& options, metrics::LogSink& sink,
                       std::unique_ptr<security::SecretFiles> secrets,
                       std::unique_ptr<tracing::CallTracer> tracer)
    : options_(options),
      log_(sink, absl::Now, LogOptionsOf(options.logging)),
      tracer_(std::move(tracer)),
      secrets_(std::move(secrets)),
      admission_(AdmissionOf(options)),
      scheduler_(batching::MakeBatcher(Batching(options), common::Clock::Real(), &metrics_)),
      service_(Parts()) {
  metrics_.SetQueueLength([this] { return static_cast<double>(scheduler_->queued_windows()); });
  metrics_.SetCapacity({options_.max_calls, options_.max_queued_windows, options_.workers});
  metrics_.SetBuild(DUET_VERSION);
  metrics_.SetModels([this] { return Served(registry_); });
  if (secrets_->certificates() != nullptr) {
    metrics_.SetCertificateEnd(
        [this] { return static_cast<double>(absl::ToUnixSeconds(secrets_->certificate_end())); });
  }
  if (tracer_ != nullptr) {
    metrics_.SetSpans([this] { return metrics::SpanCounts{tracer_->sent(), tracer_->dropped()}; });
  }
  metrics_.SetDroppedLogLines([&sink] { return static_cast<double>(sink.dropped_lines()); });
}

DuetServer::~DuetServer() {
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
  parts.observers = {&metrics_, &log_};
  if (tracer_ != nullptr) {
    parts.observers.push_back(tracer_.get());
    parts.trace_ratio = options_.tracing.ratio;
  }
  parts.guard = security::CallGuard(secrets_->access());
  parts.limits = Limits(options_);
  parts.reception.timeout_seconds = options_.receive_timeout_seconds;
  parts.buffered_frames = options_.buffered_frames;
  parts.write_timeout_seconds = options_.write_timeout_seconds;
  parts.max_call_seconds = options_.max_call_seconds;
  parts.client_key = options_.client_key;
  parts.clean_up = options_.clean_up;
  return parts;
}

absl::Status DuetServer::Listen() {
  absl::StatusOr<GrpcServer> grpc = StartGrpcServer(
      {options_.listen, options_.reflection, options_.max_request_bytes,
       options_.max_transport_bytes, options_.max_calls, options_.max_call_seconds, Credentials()},
      service_);
  if (!grpc.ok()) return grpc.status();
  grpc_ = *std::move(grpc);
  SetHealth(false);
  Watch();
  if (!options_.metrics_listen.has_value()) return absl::OkStatus();
  metrics::MetricsEndpointOptions endpoint;
  endpoint.host = options_.metrics_listen->host;
  endpoint.port = options_.metrics_listen->port;
  endpoint.render = [this] { return metrics_.Render(); };
  endpoint.healthy = [this] { return self_check_ == nullptr || self_check_->healthy(); };
  endpoint.ready = [this] { return admission_.state() == service::Admission::State::kServing; };
  absl::StatusOr<std::unique_ptr<metrics::MetricsEndpoint>> started =
      metrics::MetricsEndpoint::Start(std::move(endpoint));
  if (!started.ok()) return started.status();
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

void DuetServer::Watch() {
  watch_.push_back(std::make_unique<RepeatedTask>(kLookSeconds, [this] { service_.CheckTime(); }));
  watch_.push_back(std::make_unique<RepeatedTask>(kTrimSeconds, [this] {
    heap_trimmer_.Look(service_.large_request_bytes(), admission_.held_bytes());
  }));
  watch_.push_back(std::make_unique<RepeatedTask>(kHousekeepingSeconds, [this] {
    Tell(secrets_->Look());
    log_.TellUnlogged();
  }));
  if (options_.self_check_seconds <= 0) return;
  SelfCheckOptions check;
  check.host = options_.listen.host;
  check.port = grpc_.port;
  check.interval_seconds = options_.self_check_seconds;
  check.failed = [this](const absl::Status& status) {
    log_.Error("self_check_failed", {{"message", std::string(status.message())}});
  };
  self_check_ = std::make_unique<SelfCheck>(std::move(check));
}

void DuetServer::Add(const registry::LoadReport& report) {
  metrics_.ModelLoaded(report.source, report.load_seconds, report.model.ok());
  if (!report.model.ok()) {
    log_.Error("model_refused",
               {{"source", report.source}, {"message", report.model.status().ToString()}});
    return;
  }
  registry_.Serve(*report.model);
  const engine::ModelDescription& model = (*report.model)->description();
  log_.Info("model_loaded", {{"source", report.source},
                             {"model", model.name},
                             {"version", model.version},
                             {"seconds", report.load_seconds}});
}

absl::Status DuetServer::Serve() {
  if (registry_.List().empty()) return absl::FailedPreconditionError("no model could be loaded");
  for (const config::VersionLabelOption& label : options_.version_labels) {
    const absl::Status set = registry_.SetLabel(label.model, label.label, label.version);
    if (!set.ok()) log_.Error("version_label_refused", {{"message", std::string(set.message())}});
  }
  if (!options_.default_model.empty()) {
    const absl::Status set = registry_.SetDefault(options_.default_model);
    if (!set.ok()) return set;
  }
  admission_.SetState(service::Admission::State::kServing);
  SetHealth(true);
  log_.Info("serving", {{"port", port()},
                        {"metrics_port", metrics_port()},
                        {"workers", options_.workers},
                        {"threads_per_worker", options_.engine.threads},
                        {"max_batch_windows", options_.max_batch_windows}});
  return absl::OkStatus();
}

void DuetServer::Drain(const std::function<bool(double seconds)>& wait) {
  log_.Info("draining", {{"calls", admission_.calls()}});
  SetHealth(false);
  bool patient = options_.drain_seconds <= 0 || wait(options_.drain_seconds);
  // From here on new calls are refused as UNAVAILABLE. gRPC's own Shutdown comes last: it would
  // wait for health watches as well, which never end by themselves.
  admission_.SetState(service::Admission::State::kDraining);
  double left = options_.grace_seconds;
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
  grpc_.server->Shutdown(std::chrono::system_clock::now() + kFlush);
}

void DuetServer::SetHealth(bool serving) {
  grpc::HealthCheckServiceInterface* health = grpc_.server->GetHealthCheckService();
  health->SetServingStatus("", serving);
  health->SetServingStatus(service::MotionSynthesisService::kServiceName, serving);
  for (const registry::ServedModel& served : registry_.List()) {
    health->SetServingStatus(absl::StrCat("model:", served.model->description().name), serving);
  }
}

}  // namespace duet::server::lifecycle
