#include "server/metrics/server_metrics.h"

#include <prometheus/text_serializer.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "absl/status/status.h"
#include "server/common/error_details.h"

namespace duet::server::metrics {

namespace {

using Families = std::vector<prometheus::MetricFamily>;

// A gauge and a counter without labels.
prometheus::MetricFamily Gauge(const std::string& name, const std::string& help, double value) {
  prometheus::ClientMetric metric;
  metric.gauge.value = value;
  return {name, help, prometheus::MetricType::Gauge, {metric}};
}

prometheus::MetricFamily Counter(const std::string& name, const std::string& help, double value) {
  prometheus::ClientMetric metric;
  metric.counter.value = value;
  return {name, help, prometheus::MetricType::Counter, {metric}};
}

// The virtual and the resident memory of this process in bytes; 0 if they cannot be read.
std::pair<std::uint64_t, std::uint64_t> ReadMemory() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t pages = 0, resident = 0;
  if (!(file >> pages >> resident)) return {0, 0};
  const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  return {pages * page, resident * page};
}

double CountEntries(const char* folder) {
  std::error_code error;
  const std::filesystem::directory_iterator entries(folder, error);
  return error ? 0 : static_cast<double>(std::distance(begin(entries), end(entries)));
}

double Seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

// The standard process metrics of Prometheus clients.
void AddProcessMetrics(double start_seconds, Families& families) {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  families.push_back(Counter("process_cpu_seconds_total",
                             "Total user and system CPU time spent in seconds.",
                             Seconds(usage.ru_utime) + Seconds(usage.ru_stime)));
  families.push_back(
      Gauge("process_threads", "Number of threads.", CountEntries("/proc/self/task")));
  const auto [virtual_bytes, resident_bytes] = ReadMemory();
  families.push_back(Gauge("process_virtual_memory_bytes", "Virtual memory size in bytes.",
                           static_cast<double>(virtual_bytes)));
  families.push_back(Gauge("process_resident_memory_bytes", "Resident memory size in bytes.",
                           static_cast<double>(resident_bytes)));
  families.push_back(Gauge("process_start_time_seconds",
                           "Start time of the process since unix epoch in seconds.",
                           start_seconds));
  // One of them belongs to the count, which fails if none is left.
  families.push_back(Gauge("process_open_fds", "Number of open file descriptors.",
                           std::max(0.0, CountEntries("/proc/self/fd") - 1)));
  rlimit limit = {};
  getrlimit(RLIMIT_NOFILE, &limit);
  families.push_back(Gauge("process_max_fds", "Maximum number of open file descriptors.",
                           static_cast<double>(limit.rlim_cur)));
}

using prometheus::Labels;

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
prometheus::MetricFamily ModelInfo(const std::vector<registry::ServedModel>& models) {
  prometheus::MetricFamily family;
  family.name = "duet_model_info";
  family.help = "1 for each model version that is served.";
  family.type = prometheus::MetricType::Gauge;
  for (const registry::ServedModel& model : models) {
    const engine::ModelDescription& description = model.model->description();
    prometheus::ClientMetric metric;
    metric.label = {{"model", description.name},
                    {"version", std::to_string(description.version)},
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

std::uint64_t ResidentBytes() { return ReadMemory().second; }

ServerMetrics::Counters& ServerMetrics::NewCounters(const char* name, const char* help) {
  return prometheus::BuildCounter().Name(name).Help(help).Register(registry_);
}

ServerMetrics::Gauges& ServerMetrics::NewGauges(const char* name, const char* help) {
  return prometheus::BuildGauge().Name(name).Help(help).Register(registry_);
}

ServerMetrics::Histograms& ServerMetrics::NewHistograms(const char* name, const char* help) {
  return prometheus::BuildHistogram().Name(name).Help(help).Register(registry_);
}

ServerMetrics::ServerMetrics() {
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
  handling_seconds_.Add(labels, seconds_buckets_).Observe(record.total_seconds);
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
    first_chunk_seconds_.Add({{"priority", std::string(record.priority)}}, seconds_buckets_)
        .Observe(record.first_chunk_seconds);
  }
  if (record.frames > 0) {
    frames_.Add({{"model", record.model}, {"version", std::to_string(record.version)}})
        .Increment(record.frames);
  }
}

void ServerMetrics::WindowFinished(batching::Priority priority,
                                   const batching::WindowTimings& timings) {
  queue_seconds_.Add(PriorityLabels(priority), seconds_buckets_).Observe(timings.queue_seconds);
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

void ServerMetrics::Describe(const std::string& version, std::uint32_t max_calls,
                             std::uint32_t max_queued_windows, std::uint32_t workers) {
  NewGauges("duet_build_info", "1; the labels identify the program.")
      .Add({{"version", version}})
      .Set(1);
  NewGauges("duet_max_calls", "Synthesize RPCs and live sessions that may be answered at a time.")
      .Add({})
      .Set(max_calls);
  NewGauges("duet_max_queued_windows",
            "First windows of RPCs that may wait for a worker, once for each candidate.")
      .Add({})
      .Set(max_queued_windows);
  NewGauges("duet_workers", "Batches that may be evaluated at a time.").Add({}).Set(workers);
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
  AddProcessMetrics(start_seconds_, families);
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace duet::server::metrics
