#ifndef DUET_SERVER_METRICS_SERVER_METRICS_H_
#define DUET_SERVER_METRICS_SERVER_METRICS_H_

#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "server/batching/window_scheduler.h"
#include "server/common/mutex.h"
#include "server/metrics/call_record.h"

namespace duet::server::metrics {

// Limits of the server.
struct Capacity {
  int calls = 0;
  int queued_windows = 0;
  int workers = 0;
};

// A model version that is served.
struct ServedVersion {
  std::string model;
  int version = 0;
  bool is_default = false;
};

// Values that every scrape reads. Metrics of functions that are absent are omitted.
struct ReadValues {
  std::function<double()> queued_windows;
  std::function<double()> places_in_use;
  std::function<double()> dropped_log_lines;
  std::function<bool()> ready;
  std::function<std::vector<ServedVersion>()> models;
  std::function<double()> certificate_end;  // seconds since 1970
};

// Every metric of the server. Durations are histograms in seconds. Label values come from what is
// served, never from a request.
//
// Of calls ("call labels" are grpc_type, grpc_service and grpc_method):
//   grpc_server_started_total{call labels}             calls begun
//   grpc_server_handled_total{call labels, grpc_code}  calls ended, by status
//   grpc_server_handling_seconds{call labels}          from a call's start to its status
//   duet_calls_in_flight{method}                       calls being answered now
//   duet_first_chunk_seconds{priority}                 from a call's start to its first chunk
//   duet_frames_total{model, version}                  follower frames sent
//   duet_refusals_total{reason}                        calls refused, by the reason of ErrorInfo
//   duet_caller_calls_total{caller, grpc_code}         calls of the access file's callers
//   duet_max_calls                                     calls that may be answered at a time: places
//   duet_places_in_use                                 places that calls and live sessions hold
// Of windows:
//   duet_queue_seconds{priority}                       one window's wait for a worker
//   duet_windows_dropped_total{priority}               never started: cancelled or too late
//   duet_queued_windows                                waiting now, once for each candidate
//   duet_max_queued_windows                            first windows that may wait, likewise
//   duet_computed_frames_total{priority}               of evaluated windows, once for each sample
// Of batches:
//   duet_compute_seconds                               one batch in the network
//   duet_batch_size                                    windows of one batch, likewise
//   duet_workers                                       batches that may be evaluated at a time
// Of the server as a whole:
//   duet_ready                                         1 while /readyz returns 200, otherwise 0
//   duet_self_check_failures_total                     failed calls of the server to itself
// Of models:
//   duet_model_load_seconds{checkpoint}                duration of the last load
//   duet_model_state{checkpoint}                       1 served, 0 rejected; absent if unloaded
//   duet_model_last_load_successful{checkpoint}        0: the files on disk were rejected; an
//                                                      earlier load may still be served
//   duet_model_info{model, version, default}           1 for each version served now
//   duet_model_loads_total{result}                     checkpoints loaded: ok or refused
//   duet_model_folders_skipped                         folders that are not checkpoints
//   duet_reloads_total{result}                         requested reloads: ok or failed
// Of certificates and the access file:
//   duet_secrets_reloads_total{kind, outcome}          times they were read again
//   duet_secrets_last_reload_successful{kind}          0: the files on disk were rejected; the
//                                                      earlier ones are still used
//   duet_tls_certificate_expiry_timestamp_seconds      end of the server's certificate
// Of the program: duet_build_info{version}, and the standard process_* (process_metrics.h).
// Of the log:
//   duet_log_lines_dropped_total                       lines lost to a slow reader or a full disk
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
  void SetCapacity(const Capacity& capacity);
  void SetBuild(const std::string& version);

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

  prometheus::Registry registry_;
  Counters& started_;
  Counters& handled_;
  Histograms& handling_seconds_;
  Gauges& in_flight_;
  Histograms& first_chunk_seconds_;
  Counters& frames_;
  Counters& computed_frames_;
  Histograms& queue_seconds_;
  prometheus::Histogram& compute_seconds_;
  prometheus::Histogram& batch_size_;
  Counters& windows_dropped_;
  prometheus::Gauge& queued_windows_;
  Gauges& load_seconds_;
  Gauges& model_state_;
  Gauges& model_last_load_;
  Counters& model_loads_;
  prometheus::Gauge& folders_skipped_;
  Counters& reloads_;
  prometheus::Counter& log_lines_dropped_;
  prometheus::Counter& self_check_failures_;
  Counters& refusals_;
  Counters& caller_calls_;
  Counters& secrets_reloads_;
  Gauges& secrets_last_reload_;
  std::atomic<std::uint64_t> batches_{0};
  ReadValues read_;
  common::Mutex render_mutex_;  // one scrape at a time updates the values that it reads
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_SERVER_METRICS_H_
