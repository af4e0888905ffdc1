#include "server/metrics/server_metrics.h"

#include <prometheus/text_serializer.h>

#include <utility>

#include "absl/status/status.h"
#include "server/common/error_details.h"
#include "server/metrics/process_metrics.h"

namespace duet::server::metrics {
namespace {

using prometheus::Labels;

// One millisecond to one minute: a window takes tens of milliseconds, a long clip a minute.
const prometheus::Histogram::BucketBoundaries& SecondsBuckets() {
  static const auto* const buckets = new prometheus::Histogram::BucketBoundaries{
      0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30, 60};
  return *buckets;
}

const prometheus::Histogram::BucketBoundaries& BatchBuckets() {
  static const auto* const buckets =
      new prometheus::Histogram::BucketBoundaries{1, 2, 4, 8, 16, 32, 64};
  return *buckets;
}

Labels MethodLabels(const MethodInfo& method) {
  return {{"grpc_type", std::string(method.type)},
          {"grpc_service", std::string(method.service)},
          {"grpc_method", std::string(method.name)}};
}

// Spelled as in go-grpc-prometheus, which dashboards expect: "OK", "InvalidArgument".
std::string CodeLabel(absl::StatusCode code) {
  static constexpr const char* kNames[] = {
      "OK",       "Canceled",       "Unknown",          "InvalidArgument",   "DeadlineExceeded",
      "NotFound", "AlreadyExists",  "PermissionDenied", "ResourceExhausted", "FailedPrecondition",
      "Aborted",  "OutOfRange",     "Unimplemented",    "Internal",          "Unavailable",
      "DataLoss", "Unauthenticated"};
  return kNames[static_cast<int>(code)];
}

// Built for every scrape, so that versions that are no longer served disappear.
prometheus::MetricFamily ModelInfo(const std::vector<ServedVersion>& models) {
  prometheus::MetricFamily family;
  family.name = "duet_model_info";
  family.help = "1 for each model version that is served.";
  family.type = prometheus::MetricType::Gauge;
  for (const ServedVersion& model : models) {
    prometheus::ClientMetric metric;
    metric.label = {{"model", model.model},
                    {"version", std::to_string(model.version)},
                    {"default", model.is_default ? "true" : "false"}};
    metric.gauge.value = 1;
    family.metric.push_back(std::move(metric));
  }
  return family;
}

Labels PriorityLabels(batching::Priority priority) {
  return {{"priority", std::string(PriorityName(priority))}};
}

}  // namespace

ServerMetrics::Counters& ServerMetrics::NewCounters(const char* name, const char* help) {
  return prometheus::BuildCounter().Name(name).Help(help).Register(registry_);
}

ServerMetrics::Gauges& ServerMetrics::NewGauges(const char* name, const char* help) {
  return prometheus::BuildGauge().Name(name).Help(help).Register(registry_);
}

ServerMetrics::Histograms& ServerMetrics::NewHistograms(const char* name, const char* help) {
  return prometheus::BuildHistogram().Name(name).Help(help).Register(registry_);
}

ServerMetrics::ServerMetrics()
    : started_(NewCounters("grpc_server_started_total", "RPCs started on the server.")),
      handled_(NewCounters("grpc_server_handled_total",
                           "RPCs completed on the server, by status code.")),
      handling_seconds_(
          NewHistograms("grpc_server_handling_seconds", "Time from an RPC's start to its status.")),
      in_flight_(NewGauges("duet_calls_in_flight", "RPCs being answered.")),
      first_chunk_seconds_(NewHistograms(
          "duet_first_chunk_seconds", "Time from a Synthesize call's start to its first chunk.")),
      frames_(NewCounters("duet_frames_total", "Follower frames sent.")),
      computed_frames_(NewCounters("duet_computed_frames_total",
                                   "Frames of evaluated windows, once for each expected sample.")),
      queue_seconds_(
          NewHistograms("duet_queue_seconds", "Time that a window waited for a worker.")),
      compute_seconds_(NewHistograms("duet_compute_seconds", "Time of one batch in the network.")
                           .Add({}, SecondsBuckets())),
      batch_size_(
          NewHistograms("duet_batch_size", "Windows evaluated together, once for each candidate.")
              .Add({}, BatchBuckets())),
      windows_dropped_(
          NewCounters("duet_windows_dropped_total",
                      "Windows that never started: cancelled, or too late for their deadline.")),
      queued_windows_(
          NewGauges("duet_queued_windows", "Windows waiting for a worker, once for each candidate.")
              .Add({})),
      load_seconds_(NewGauges("duet_model_load_seconds", "Time to load a checkpoint.")),
      model_state_(
          NewGauges("duet_model_state", "1 if the checkpoint is served, 0 if it was rejected.")),
      model_last_load_(NewGauges("duet_model_last_load_successful",
                                 "1 if the checkpoint on disk was loaded, 0 if it was rejected, "
                                 "even if an earlier load of it is served.")),
      model_loads_(NewCounters("duet_model_loads_total", "Loads of checkpoints, by result.")),
      folders_skipped_(NewGauges("duet_model_folders_skipped",
                                 "Folders in the model repository that hold no checkpoint.")
                           .Add({})),
      reloads_(NewCounters("duet_reloads_total",
                           "Requested reloads of settings and models, by result.")),
      log_lines_dropped_(
          NewCounters("duet_log_lines_dropped_total",
                      "Log lines lost because their reader was too slow or writing failed.")
              .Add({})),
      self_check_failures_(NewCounters("duet_self_check_failures_total",
                                       "Times that the server did not answer its own call.")
                               .Add({})),
      refusals_(NewCounters("duet_refusals_total",
                            "Rejected RPCs, by the reason in their error details.")),
      caller_calls_(NewCounters("duet_caller_calls_total",
                                "Completed RPCs of the access file's callers, by status code.")),
      secrets_reloads_(NewCounters("duet_secrets_reloads_total",
                                   "Reloads of changed certificates or of a changed access file.")),
      secrets_last_reload_(NewGauges("duet_secrets_last_reload_successful",
                                     "1 if the certificates or access file on disk are in use, 0 "
                                     "if they were rejected and the previous ones are.")) {
  // Start at 0: Prometheus would not see the first rejection as an increase otherwise.
  for (const char* kind : {"access", "tls"}) {
    secrets_last_reload_.Add({{"kind", kind}}).Set(1);
    for (const char* outcome : {"taken", "refused"}) {
      secrets_reloads_.Add({{"kind", kind}, {"outcome", outcome}});
    }
  }
}

void ServerMetrics::CallStarted(const MethodInfo& method) {
  started_.Add(MethodLabels(method)).Increment();
  in_flight_.Add({{"method", std::string(method.name)}}).Increment();
}

void ServerMetrics::CallFinished(const CallRecord& record) {
  Labels labels = MethodLabels(record.method);
  handling_seconds_.Add(labels, SecondsBuckets()).Observe(record.total_seconds);
  labels["grpc_code"] = CodeLabel(record.status.code());
  handled_.Add(labels).Increment();
  if (const std::string reason = common::ReasonOf(record.status); !reason.empty()) {
    refusals_.Add({{"reason", reason}}).Increment();
  }
  if (record.caller_is_listed) {
    caller_calls_.Add({{"caller", record.caller}, {"grpc_code", labels["grpc_code"]}}).Increment();
  }
  in_flight_.Add({{"method", std::string(record.method.name)}}).Decrement();
  if (record.first_chunk_seconds >= 0) {
    first_chunk_seconds_.Add({{"priority", std::string(record.priority)}}, SecondsBuckets())
        .Observe(record.first_chunk_seconds);
  }
  if (record.frames > 0) {
    frames_.Add({{"model", record.model}, {"version", std::to_string(record.version)}})
        .Increment(record.frames);
  }
}

void ServerMetrics::WindowFinished(batching::Priority priority,
                                   const batching::WindowTimings& timings) {
  queue_seconds_.Add(PriorityLabels(priority), SecondsBuckets()).Observe(timings.queue_seconds);
  if (timings.batch_size == 0) {
    windows_dropped_.Add(PriorityLabels(priority)).Increment();
  } else {
    computed_frames_.Add(PriorityLabels(priority)).Increment(timings.frames);
  }
}

void ServerMetrics::BatchFinished(const batching::WindowTimings& timings) {
  compute_seconds_.Observe(timings.compute_seconds);
  batch_size_.Observe(timings.batch_size);
  ++batches_;
}

void ServerMetrics::ModelLoaded(const std::string& checkpoint, double seconds, bool loaded,
                                bool served) {
  const Labels labels = {{"checkpoint", checkpoint}};
  load_seconds_.Add(labels).Set(seconds);
  model_state_.Add(labels).Set(served ? 1 : 0);
  model_last_load_.Add(labels).Set(loaded ? 1 : 0);
  model_loads_.Add({{"result", loaded ? "ok" : "refused"}}).Increment();
}

void ServerMetrics::ModelUnloaded(const std::string& checkpoint) {
  // An alert on 0 concerns only checkpoints that should be served.
  const Labels labels = {{"checkpoint", checkpoint}};
  model_state_.Remove(&model_state_.Add(labels));
  model_last_load_.Remove(&model_last_load_.Add(labels));
  load_seconds_.Remove(&load_seconds_.Add(labels));
}

void ServerMetrics::FoldersSkipped(int folders) { folders_skipped_.Set(folders); }

void ServerMetrics::Reloaded(bool ok) {
  reloads_.Add({{"result", ok ? "ok" : "failed"}}).Increment();
}

void ServerMetrics::SetCapacity(const Capacity& capacity) {
  const auto set = [this](const char* name, const char* help, int value) {
    NewGauges(name, help).Add({}).Set(value);
  };
  set("duet_max_calls", "Synthesize RPCs and live sessions that may be answered at a time.",
      capacity.calls);
  set("duet_max_queued_windows",
      "First windows of RPCs that may wait for a worker, once for each candidate.",
      capacity.queued_windows);
  set("duet_workers", "Batches that may be evaluated at a time.", capacity.workers);
}

void ServerMetrics::SetBuild(const std::string& version) {
  NewGauges("duet_build_info", "1; the labels identify the program.")
      .Add({{"version", version}})
      .Set(1);
}

void ServerMetrics::SecretsReloaded(const std::string& kind, bool taken) {
  secrets_reloads_.Add({{"kind", kind}, {"outcome", taken ? "taken" : "refused"}}).Increment();
  secrets_last_reload_.Add({{"kind", kind}}).Set(taken ? 1 : 0);
}

std::string ServerMetrics::Render() {
  common::MutexLock lock(render_mutex_);
  if (read_.queued_windows) queued_windows_.Set(read_.queued_windows());
  if (read_.dropped_log_lines) {
    log_lines_dropped_.Increment(read_.dropped_log_lines() - log_lines_dropped_.Value());
  }
  std::vector<prometheus::MetricFamily> families = registry_.Collect();
  if (read_.models) families.push_back(ModelInfo(read_.models()));
  if (read_.places_in_use) {
    families.push_back(Gauge("duet_places_in_use",
                             "Places, of duet_max_calls, that calls and live sessions hold.",
                             read_.places_in_use()));
  }
  if (read_.ready) {
    families.push_back(Gauge("duet_ready", "1 while the server accepts and answers calls.",
                             read_.ready() ? 1 : 0));
  }
  if (read_.certificate_end) {
    families.push_back(Gauge("duet_tls_certificate_expiry_timestamp_seconds",
                             "When the server's certificate expires.", read_.certificate_end()));
  }
  for (prometheus::MetricFamily& family : ReadProcessMetrics()) {
    families.push_back(std::move(family));
  }
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace duet::server::metrics
