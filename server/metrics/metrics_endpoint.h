#ifndef DUET_SERVER_METRICS_METRICS_ENDPOINT_H_
#define DUET_SERVER_METRICS_METRICS_ENDPOINT_H_

#include <event2/event.h>
#include <event2/http.h>

#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace duet::server::metrics {

struct MetricsEndpointOptions {
  std::string host;
  int port = 0;                         // 0: any free one
  std::function<std::string()> render;  // the Prometheus text
  std::function<bool()> healthy;        // whether the server is still reachable
  std::function<bool()> ready;          // whether calls are being served
  double idle_seconds = 5;  // maximum time that a client may neither send nor read anything
};

// A small HTTP server beside gRPC: GET /metrics for Prometheus, /healthz (200 while the process is
// healthy, otherwise 503) and /readyz (200 while calls are served, otherwise 503).
//
// One thread serves all connections without blocking: a client that sends or reads slowly, or not
// at all, delays no other client. The callbacks run on that thread and must be quick.
class MetricsEndpoint {
 public:
  // Fails with UNAVAILABLE and the reason if it cannot listen on the address.
  static absl::StatusOr<std::unique_ptr<MetricsEndpoint>> Start(MetricsEndpointOptions options);

  ~MetricsEndpoint();
  MetricsEndpoint(const MetricsEndpoint&) = delete;
  MetricsEndpoint& operator=(const MetricsEndpoint&) = delete;

  int port() const { return port_; }

 private:
  template <typename Part>
  using Owned = std::unique_ptr<Part, void (*)(Part*)>;

  explicit MetricsEndpoint(MetricsEndpointOptions options);
  absl::Status Listen();
  void Answer(evhttp_request* request) const;

  const MetricsEndpointOptions options_;
  const int stop_;  // an eventfd: the only part of the loop that other threads may use
  const Owned<event_base> loop_;
  const Owned<evhttp> http_;
  const Owned<event> stopped_;
  int port_ = 0;
  std::thread thread_;
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_METRICS_ENDPOINT_H_
