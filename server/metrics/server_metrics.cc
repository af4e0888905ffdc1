#include "server/metrics/server_metrics.h"

#include <prometheus/text_serializer.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstddef>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
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

// Returns the fields of /proc/self/stat after the program's name, which may contain any character.
// The first is the state, field 3 in proc(5).
std::vector<std::string> StatFields() {
  std::ifstream file("/proc/self/stat");
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return {};
  std::istringstream words(text.substr(name_end + 1));
  return {std::istream_iterator<std::string>(words), std::istream_iterator<std::string>()};
}

// The boot time in seconds since 1970. Measured once, so that it is the same in every scrape.
double BootTime() {
  static const double boot_time = [] {
    timespec now = {}, uptime = {};
    clock_gettime(CLOCK_REALTIME, &now);
    clock_gettime(CLOCK_BOOTTIME, &uptime);
    return static_cast<double>(now.tv_sec - uptime.tv_sec);
  }();
  return boot_time;
}

void AddStat(Families& families) {
  // Field numbers of proc(5); `fields` begins with number 3.
  constexpr std::size_t kUserTime = 14, kSystemTime = 15, kThreads = 20, kStart = 22,
                        kVirtualMemory = 23, kResidentPages = 24;
  const std::vector<std::string> fields = StatFields();
  if (fields.size() <= kResidentPages - 3) return;
  const auto field = [&fields](std::size_t number) { return std::stod(fields[number - 3]); };
  const auto ticks = static_cast<double>(sysconf(_SC_CLK_TCK));
  families.push_back(Counter("process_cpu_seconds_total",
                             "Total user and system CPU time spent in seconds.",
                             (field(kUserTime) + field(kSystemTime)) / ticks));
  families.push_back(Gauge("process_threads", "Number of threads.", field(kThreads)));
  families.push_back(Gauge("process_virtual_memory_bytes", "Virtual memory size in bytes.",
                           field(kVirtualMemory)));
  families.push_back(Gauge("process_resident_memory_bytes", "Resident memory size in bytes.",
                           field(kResidentPages) * static_cast<double>(sysconf(_SC_PAGESIZE))));
  families.push_back(Gauge("process_start_time_seconds",
                           "Start time of the process since unix epoch in seconds.",
                           BootTime() + field(kStart) / ticks));
}

void AddDescriptors(Families& families) {
  std::error_code error;
  const std::filesystem::directory_iterator open("/proc/self/fd", error);
  if (!error) {
    // One of them belongs to this iterator.
    families.push_back(Gauge("process_open_fds", "Number of open file descriptors.",
                             static_cast<double>(std::distance(begin(open), end(open)) - 1)));
  }
  rlimit limit = {};
  if (getrlimit(RLIMIT_NOFILE, &limit) == 0) {
    families.push_back(Gauge("process_max_fds", "Maximum number of open file descriptors.",
                             static_cast<double>(limit.rlim_cur)));
  }
}

// Reads the standard process metrics of Prometheus clients from /proc:
//   process_cpu_seconds_total, process_start_time_seconds, process_threads,
//   process_resident_memory_bytes, process_virtual_memory_bytes, process_open_fds, process_max_fds
// Metrics that cannot be read are omitted.
Families ReadProcessMetrics() {
  Families families;
  AddStat(families);
  AddDescriptors(families);
  return families;
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

std::uint64_t ResidentBytes() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t pages = 0, resident = 0;
  if (!(file >> pages >> resident)) return 0;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

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
  for (prometheus::MetricFamily& family : ReadProcessMetrics()) {
    families.push_back(std::move(family));
  }
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace duet::server::metrics
