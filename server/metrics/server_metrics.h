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
#include "server/metrics/call_record.h"

namespace duet::server::metrics {

// Every number that the server gives to Prometheus. Durations are histograms in seconds; labels
// take their values from what is served, never from a request.
//
//   grpc_server_started_total{grpc_type, grpc_service, grpc_method}
//   grpc_server_handled_total{..., grpc_code}
//   grpc_server_handling_seconds{...}
//   duet_calls_in_flight{method}
//   duet_first_chunk_seconds{priority}     admission to the first chunk
//   duet_frames_total{model, version}      frames sent
//   duet_queue_seconds{priority}           one window's wait for a worker
//   duet_compute_seconds                   one evaluation of the network
//   duet_batch_size                        windows evaluated together
//   duet_windows_dropped_total{priority}   windows that never started: cancelled or expired
//   duet_queued_windows                    windows waiting now
//   duet_model_load_seconds{checkpoint}
//   duet_model_state{checkpoint}           1 served, 0 failed to load
//
// Threads: safe to call concurrently.
class ServerMetrics final : public CallObserver {
 public:
  ServerMetrics();

  void CallStarted(const MethodInfo& method) override;
  void CallFinished(const CallRecord& record) override;

  // A window left the queue.
  void WindowFinished(batching::Priority priority, const batching::WindowTimings& timings);
  // A checkpoint was loaded, or was refused.
  void ModelLoaded(const std::string& checkpoint, double seconds, bool served);
  // Asks for the number of waiting windows at every scrape.
  void SetQueueLength(std::function<double()> queued_windows);

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
  std::function<double()> queue_length_;
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_SERVER_METRICS_H_
