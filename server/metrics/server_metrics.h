#ifndef DUET_SERVER_METRICS_SERVER_METRICS_H_
#define DUET_SERVER_METRICS_SERVER_METRICS_H_

#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <functional>
#include <string>

#include "server/batching/window_scheduler.h"
#include "server/common/mutex.h"
#include "server/metrics/call_record.h"

namespace duet::server::metrics {

// Every number that the server gives to Prometheus. Durations are histograms in seconds; labels
// take their values from what is served, never from a request.
//
// Of calls ("call labels" are grpc_type, grpc_service and grpc_method):
//   grpc_server_started_total{call labels}             calls begun
//   grpc_server_handled_total{call labels, grpc_code}  calls ended, by status
//   grpc_server_handling_seconds{call labels}          from a call's start to its status
//   duet_calls_in_flight{method}                       calls being answered now
//   duet_first_chunk_seconds{priority}                 from a call's start to its first chunk
//   duet_frames_total{model, version}                  follower frames sent
// Of windows:
//   duet_queue_seconds{priority}                       one window's wait for a worker
//   duet_windows_dropped_total{priority}               never started: cancelled, or too late
//   duet_queued_windows                                waiting now
// Of batches:
//   duet_compute_seconds                               one batch in the network
//   duet_batch_size                                    windows of one batch
// Of models:
//   duet_model_load_seconds{checkpoint}                time that loading took
//   duet_model_state{checkpoint}                       1 served, 0 failed to load or unloaded
//   duet_model_loads_total{result}                     checkpoints loaded: ok or refused
//   duet_model_folders_skipped                         in the repository, but no checkpoints
//   duet_reloads_total{result}                         reloads asked for: ok or failed
// Of the log:
//   duet_log_lines_dropped_total                       lines lost to a slow reader of the log
//
// Threads: safe to call concurrently.
class ServerMetrics final : public CallObserver, public batching::WindowObserver {
 public:
  ServerMetrics();

  void CallStarted(const MethodInfo& method) override;
  void CallFinished(const CallRecord& record) override;

  void BatchFinished(const batching::WindowTimings& timings) override;
  void WindowFinished(batching::Priority priority, const batching::WindowTimings& timings) override;

  // A checkpoint was loaded, or was refused; `served` tells of a refused one whether what was
  // loaded before in its place is served on.
  void ModelLoaded(const std::string& checkpoint, double seconds, bool loaded, bool served);
  void ModelUnloaded(const std::string& checkpoint);
  void FoldersSkipped(int folders);
  void Reloaded(bool ok);

  // What is asked for at every scrape. Call before the first Render.
  void SetQueueLength(std::function<double()> queued_windows);
  void SetDroppedLogLines(std::function<double()> dropped_log_lines);

  // The Prometheus text format.
  std::string Render();

 private:
  prometheus::Registry registry_;
  prometheus::Family<prometheus::Counter>& started_;
  prometheus::Family<prometheus::Counter>& handled_;
  prometheus::Family<prometheus::Histogram>& handling_seconds_;
  prometheus::Family<prometheus::Gauge>& in_flight_;
  prometheus::Family<prometheus::Histogram>& first_chunk_seconds_;
  prometheus::Family<prometheus::Counter>& frames_;
  prometheus::Family<prometheus::Histogram>& queue_seconds_;
  prometheus::Histogram& compute_seconds_;
  prometheus::Histogram& batch_size_;
  prometheus::Family<prometheus::Counter>& windows_dropped_;
  prometheus::Gauge& queued_windows_;
  prometheus::Family<prometheus::Gauge>& load_seconds_;
  prometheus::Family<prometheus::Gauge>& model_state_;
  prometheus::Family<prometheus::Counter>& model_loads_;
  prometheus::Gauge& folders_skipped_;
  prometheus::Family<prometheus::Counter>& reloads_;
  prometheus::Counter& log_lines_dropped_;
  std::function<double()> queue_length_;
  std::function<double()> dropped_log_lines_;
  common::Mutex render_mutex_;  // one scrape brings the numbers that are asked for up to date
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_SERVER_METRICS_H_
