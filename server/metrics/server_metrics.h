#ifndef DUET_SERVER_METRICS_SERVER_METRICS_H_
#define DUET_SERVER_METRICS_SERVER_METRICS_H_

#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "server/batching/window_scheduler.h"
#include "server/common/mutex.h"
#include "server/metrics/call_record.h"
#include "server/registry/model_registry.h"

namespace duet::server::metrics {

// Returns the resident memory of this process; 0 if it cannot be read.
std::uint64_t ResidentBytes();

// Values that every scrape reads. Metrics of functions that are absent are omitted.
struct ReadValues {
  std::function<double()> queued_windows;
  std::function<double()> places_in_use;
  std::function<double()> dropped_log_lines;
  std::function<bool()> ready;
  std::function<std::vector<registry::ServedModel>()> models;
  std::function<double()> certificate_end;  // seconds since 1970
};

// Every metric of the server (docs/metrics.md). Durations are histograms in seconds. Label values
// come from what is served, never from a request.
//
// Threads: safe to call concurrently.
class ServerMetrics final : public CallObserver, public batching::WindowObserver {
 public:
  ServerMetrics();

  void CallStarted(const MethodInfo& method) override;
  void CallFinished(const CallRecord& record) override;

  void BatchFinished(const batching::WindowTimings& timings) override;
  void WindowFinished(batching::Priority priority, const batching::WindowTimings& timings) override;

  // Records a checkpoint that was loaded or rejected. `served`: whether a version of it is served,
  // which may be an earlier load.
  void ModelLoaded(const std::string& checkpoint, double seconds, bool loaded, bool served);
  // Records a checkpoint that is no longer served, nor should be.
  void ModelUnloaded(const std::string& checkpoint);
  void FoldersSkipped(int folders);
  void Reloaded(bool ok);
  void SelfCheckFailed() { self_check_failures_.Increment(); }
  // Batches evaluated since the start.
  std::uint64_t batches() const { return batches_; }

  // Call before the first Render.
  void SetRead(ReadValues read) { read_ = std::move(read); }
  // Sets what does not change: the version of the program and the limits of the server.
  void Describe(const std::string& version, std::uint32_t max_calls,
                std::uint32_t max_queued_windows, std::uint32_t workers);

  // Records that the files of one kind were read again, and accepted or rejected.
  void SecretsReloaded(const std::string& kind, bool taken);

  // Returns all metrics in the Prometheus text format.
  std::string Render();

 private:
  using Counters = prometheus::Family<prometheus::Counter>;
  using Gauges = prometheus::Family<prometheus::Gauge>;
  using Histograms = prometheus::Family<prometheus::Histogram>;

  Counters& NewCounters(const char* name, const char* help);
  Gauges& NewGauges(const char* name, const char* help);
  Histograms& NewHistograms(const char* name, const char* help);

  // One millisecond to one minute: a window takes tens of milliseconds, a long clip a minute.
  const prometheus::Histogram::BucketBoundaries seconds_buckets_ = {
      0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30, 60};
  const prometheus::Histogram::BucketBoundaries batch_buckets_ = {1, 2, 4, 8, 16, 32, 64};
  prometheus::Registry registry_;
  Counters& started_ = NewCounters("grpc_server_started_total", "RPCs started on the server.");
  Counters& handled_ =
      NewCounters("grpc_server_handled_total", "RPCs completed on the server, by status code.");
  Histograms& handling_seconds_ =
      NewHistograms("grpc_server_handling_seconds", "Time from an RPC's start to its status.");
  Gauges& in_flight_ = NewGauges("duet_calls_in_flight", "RPCs being answered.");
  Histograms& first_chunk_seconds_ = NewHistograms(
      "duet_first_chunk_seconds", "Time from a Synthesize call's start to its first chunk.");
  Counters& frames_ = NewCounters("duet_frames_total", "Follower frames sent.");
  Counters& computed_frames_ = NewCounters(
      "duet_computed_frames_total", "Frames of evaluated windows, once for each expected sample.");
  Histograms& queue_seconds_ =
      NewHistograms("duet_queue_seconds", "Time that a window waited for a worker.");
  prometheus::Histogram& compute_seconds_ =
      NewHistograms("duet_compute_seconds", "Time of one batch in the network.")
          .Add({}, seconds_buckets_);
  prometheus::Histogram& batch_size_ =
      NewHistograms("duet_batch_size", "Windows evaluated together, once for each candidate.")
          .Add({}, batch_buckets_);
  Counters& windows_dropped_ =
      NewCounters("duet_windows_dropped_total",
                  "Windows that never started: cancelled, or too late for their deadline.");
  prometheus::Gauge& queued_windows_ =
      NewGauges("duet_queued_windows", "Windows waiting for a worker, once for each candidate.")
          .Add({});
  Gauges& load_seconds_ = NewGauges("duet_model_load_seconds", "Time to load a checkpoint.");
  Gauges& model_state_ =
      NewGauges("duet_model_state", "1 if the checkpoint is served, 0 if it was rejected.");
  Gauges& model_last_load_ =
      NewGauges("duet_model_last_load_successful",
                "1 if the checkpoint on disk was loaded, 0 if it was rejected, "
                "even if an earlier load of it is served.");
  Counters& model_loads_ =
      NewCounters("duet_model_loads_total", "Loads of checkpoints, by result.");
  prometheus::Gauge& folders_skipped_ =
      NewGauges("duet_model_folders_skipped",
                "Folders in the model repository that hold no checkpoint.")
          .Add({});
  Counters& reloads_ =
      NewCounters("duet_reloads_total", "Requested reloads of settings and models, by result.");
  prometheus::Counter& log_lines_dropped_ =
      NewCounters("duet_log_lines_dropped_total",
                  "Log lines lost because their reader was too slow or writing failed.")
          .Add({});
  prometheus::Counter& self_check_failures_ =
      NewCounters("duet_self_check_failures_total",
                  "Times that the server did not answer its own call.")
          .Add({});
  Counters& refusals_ =
      NewCounters("duet_refusals_total", "Rejected RPCs, by the reason in their error details.");
  Counters& caller_calls_ = NewCounters(
      "duet_caller_calls_total", "Completed RPCs of the access file's callers, by status code.");
  Counters& secrets_reloads_ = NewCounters(
      "duet_secrets_reloads_total", "Reloads of changed certificates or of a changed access file.");
  Gauges& secrets_last_reload_ =
      NewGauges("duet_secrets_last_reload_successful",
                "1 if the certificates or access file on disk are in use, 0 "
                "if they were rejected and the previous ones are.");
  std::atomic<std::uint64_t> batches_{0};
  // The process starts not much earlier.
  const double start_seconds_ =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  ReadValues read_;
  common::Mutex render_mutex_;  // one scrape at a time updates the values that it reads
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_SERVER_METRICS_H_
