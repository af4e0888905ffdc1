#include "server/metrics/server_metrics.h"

#include <prometheus/text_serializer.h>

#include <utility>

#include "absl/status/status.h"
#include "server/common/error_details.h"
#include "server/metrics/process_metrics.h"

namespace duet::server::metrics {
namespace {

using prometheus::BuildCounter;
using prometheus::BuildGauge;
using prometheus::BuildHistogram;
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

ServerMetrics::ServerMetrics()
    : started_(BuildCounter()
                   .Name("grpc_server_started_total")
                   .Help("RPCs started on the server.")
                   .Register(registry_)),
      handled_(BuildCounter()
                   .Name("grpc_server_handled_total")
                   .Help("RPCs completed on the server, by status code.")
                   .Register(registry_)),
      handling_seconds_(BuildHistogram()
                            .Name("grpc_server_handling_seconds")
                            .Help("Time from an RPC's start to its status.")
                            .Register(registry_)),
      in_flight_(BuildGauge()
                     .Name("duet_calls_in_flight")
                     .Help("RPCs being answered.")
                     .Register(registry_)),
      first_chunk_seconds_(BuildHistogram()
                               .Name("duet_first_chunk_seconds")
                               .Help("Time from a Synthesize call's start to its first chunk.")
                               .Register(registry_)),
      frames_(BuildCounter()
                  .Name("duet_frames_total")
                  .Help("Follower frames sent.")
                  .Register(registry_)),
      computed_frames_(BuildCounter()
                           .Name("duet_computed_frames_total")
                           .Help("Frames of evaluated windows, once for each expected sample.")
                           .Register(registry_)),
      queue_seconds_(BuildHistogram()
                         .Name("duet_queue_seconds")
                         .Help("Time that a window waited for a worker.")
                         .Register(registry_)),
      compute_seconds_(BuildHistogram()
                           .Name("duet_compute_seconds")
                           .Help("Time of one batch in the network.")
                           .Register(registry_)
                           .Add({}, SecondsBuckets())),
      batch_size_(BuildHistogram()
                      .Name("duet_batch_size")
                      .Help("Windows evaluated together, once for each candidate.")
                      .Register(registry_)
                      .Add({}, BatchBuckets())),
      windows_dropped_(
          BuildCounter()
              .Name("duet_windows_dropped_total")
              .Help("Windows that never started: cancelled, or too late for their deadline.")
              .Register(registry_)),
      queued_windows_(BuildGauge()
                          .Name("duet_queued_windows")
                          .Help("Windows waiting for a worker, once for each candidate.")
                          .Register(registry_)
                          .Add({})),
      load_seconds_(BuildGauge()
                        .Name("duet_model_load_seconds")
                        .Help("Time to load a checkpoint.")
                        .Register(registry_)),
      model_state_(BuildGauge()
                       .Name("duet_model_state")
                       .Help("1 if the checkpoint is served, 0 if it was rejected.")
                       .Register(registry_)),
      model_last_load_(
          BuildGauge()
              .Name("duet_model_last_load_successful")
              .Help("1 if the checkpoint on disk was loaded, 0 if it was rejected, even "
                    "if an earlier load of it is served.")
              .Register(registry_)),
      model_loads_(BuildCounter()
                       .Name("duet_model_loads_total")
                       .Help("Loads of checkpoints, by result.")
                       .Register(registry_)),
      folders_skipped_(BuildGauge()
                           .Name("duet_model_folders_skipped")
                           .Help("Folders in the model repository that hold no checkpoint.")
                           .Register(registry_)
                           .Add({})),
      reloads_(BuildCounter()
                   .Name("duet_reloads_total")
                   .Help("Requested reloads of settings and models, by result.")
                   .Register(registry_)),
      log_lines_dropped_(
          BuildCounter()
              .Name("duet_log_lines_dropped_total")
              .Help("Log lines lost because their reader was too slow or writing failed.")
              .Register(registry_)
              .Add({})),
      self_check_failures_(BuildCounter()
                               .Name("duet_self_check_failures_total")
                               .Help("Times that the server did not answer its own call.")
                               .Register(registry_)
                               .Add({})),
      refusals_(BuildCounter()
                    .Name("duet_refusals_total")
                    .Help("Rejected RPCs, by the reason in their error details.")
                    .Register(registry_)),
      caller_calls_(BuildCounter()
                        .Name("duet_caller_calls_total")
                        .Help("Completed RPCs of the access file's callers, by status code.")
                        .Register(registry_)),
      secrets_reloads_(BuildCounter()
                           .Name("duet_secrets_reloads_total")
                           .Help("Reloads of changed certificates or of a changed access file.")
                           .Register(registry_)),
      secrets_last_reload_(
          BuildGauge()
              .Name("duet_secrets_last_reload_successful")
              .Help("1 if the certificates or access file on disk are in use, 0 if they were "
                    "rejected and the previous ones are.")
              .Register(registry_)) {
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

void ServerMetrics::SetQueueLength(std::function<double()> queued_windows) {
  queue_length_ = std::move(queued_windows);
}

void ServerMetrics::SetPlacesInUse(std::function<double()> places_in_use) {
  places_in_use_ = std::move(places_in_use);
}

void ServerMetrics::SetDroppedLogLines(std::function<double()> dropped_log_lines) {
  dropped_log_lines_ = std::move(dropped_log_lines);
}

void ServerMetrics::SetReady(std::function<bool()> ready) { ready_ = std::move(ready); }

void ServerMetrics::SetLongestStep(std::function<double()> seconds) {
  longest_step_ = std::move(seconds);
}

void ServerMetrics::SetModels(std::function<std::vector<ServedVersion>()> models) {
  models_ = std::move(models);
}

void ServerMetrics::SetCertificateEnd(std::function<double()> certificate_end) {
  certificate_end_ = std::move(certificate_end);
}

void ServerMetrics::SetSpans(std::function<SpanCounts()> spans) { spans_ = std::move(spans); }

void ServerMetrics::SetCapacity(const Capacity& capacity) {
  const auto set = [this](const char* name, const char* help, int value) {
    BuildGauge().Name(name).Help(help).Register(registry_).Add({}).Set(value);
  };
  set("duet_max_calls", "Synthesize RPCs and live sessions that may be answered at a time.",
      capacity.calls);
  set("duet_max_queued_windows",
      "First windows of RPCs that may wait for a worker, once for each candidate.",
      capacity.queued_windows);
  set("duet_workers", "Batches that may be evaluated at a time.", capacity.workers);
}

void ServerMetrics::SetBuild(const std::string& version) {
  BuildGauge()
      .Name("duet_build_info")
      .Help("1; the labels identify the program.")
      .Register(registry_)
      .Add({{"version", version}})
      .Set(1);
}

void ServerMetrics::SecretsReloaded(const std::string& kind, bool taken) {
  secrets_reloads_.Add({{"kind", kind}, {"outcome", taken ? "taken" : "refused"}}).Increment();
  secrets_last_reload_.Add({{"kind", kind}}).Set(taken ? 1 : 0);
}

std::string ServerMetrics::Render() {
  common::MutexLock lock(render_mutex_);
  if (queue_length_) queued_windows_.Set(queue_length_());
  if (dropped_log_lines_) {
    log_lines_dropped_.Increment(dropped_log_lines_() - log_lines_dropped_.Value());
  }
  std::vector<prometheus::MetricFamily> families = registry_.Collect();
  if (models_) families.push_back(ModelInfo(models_()));
  if (places_in_use_) {
    families.push_back(Gauge("duet_places_in_use",
                             "Places, of duet_max_calls, that calls and live sessions hold.",
                             places_in_use_()));
  }
  if (ready_) {
    families.push_back(
        Gauge("duet_ready", "1 while the server accepts and answers calls.", ready_() ? 1 : 0));
  }
  if (longest_step_) {
    families.push_back(Gauge("duet_longest_step_seconds",
                             "Duration of the longest step in progress of any thread.",
                             longest_step_()));
  }
  if (certificate_end_) {
    families.push_back(Gauge("duet_tls_certificate_expiry_timestamp_seconds",
                             "When the server's certificate expires.", certificate_end_()));
  }
  if (spans_) {
    const SpanCounts spans = spans_();
    families.push_back(Counter("duet_spans_sent_total", "Spans that the collector accepted.",
                               static_cast<double>(spans.sent)));
    families.push_back(Counter("duet_spans_dropped_total",
                               "Spans lost because the collector was unavailable or too slow.",
                               static_cast<double>(spans.dropped)));
  }
  for (prometheus::MetricFamily& family : ReadProcessMetrics()) {
    families.push_back(std::move(family));
  }
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace duet::server::metrics
