#ifndef DUET_SERVER_METRICS_METRICS_ENDPOINT_H_
#define DUET_SERVER_METRICS_METRICS_ENDPOINT_H_

#include <functional>
#include <memory>
#include <string>

#include "absl/status/statusor.h"

namespace duet::server::metrics {

struct MetricsEndpointOptions {
  std::string host;
  int port = 0;                         // 0: any free one
  std::function<std::string()> render;  // the Prometheus text
  std::function<bool()> healthy;        // whether the server is still reachable
  std::function<bool()> ready;          // whether calls are being served
  // Describes the state in detail, in lines for people. May be null.
  std::function<std::string()> describe;
  // Maximum duration of a connection, from accept to close, and maximum number of connections. A
  // new connection replaces the oldest.
  double connection_seconds = 5;
  std::size_t max_connections = 256;
};

// A small HTTP server beside gRPC: GET /metrics for Prometheus, /healthz (200 while the process is
// healthy, otherwise 503) and /readyz (200 while calls are served, otherwise 503; the body
// describes the state).
//
// One thread serves all connections without blocking: a client that sends or reads slowly, or not
// at all, delays no other client. The callbacks run on that thread and must be quick.
class MetricsEndpoint {
 public:
  // Fails with UNAVAILABLE and the reason if it cannot listen on the address.
  static absl::StatusOr<std::unique_ptr<MetricsEndpoint>> Start(MetricsEndpointOptions options);

  virtual ~MetricsEndpoint() = default;
  virtual int port() const = 0;
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_METRICS_ENDPOINT_H_
