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
  std::function<bool()> healthy;        // whether the server can still be reached
  std::function<bool()> ready;          // whether calls are being served
  // How it stands in detail, for people: lines. May be empty.
  std::function<std::string()> describe;
  // How long a connection may last, from the first byte to the last, and how many there may be: the
  // oldest makes room for the next.
  double connection_seconds = 5;
  std::size_t max_connections = 256;
};

// A small HTTP server beside gRPC: GET /metrics for Prometheus, /healthz (200 while the process
// answers and is healthy, else 503) and /readyz (200 while calls are served, else 503; the text
// says how it stands).
//
// One thread and no waiting: whoever sends or reads slowly, or says nothing, holds up nobody. The
// callbacks run on that thread, and must be quick.
class MetricsEndpoint {
 public:
  // Fails with UNAVAILABLE and the reason when the address cannot be listened on.
  static absl::StatusOr<std::unique_ptr<MetricsEndpoint>> Start(MetricsEndpointOptions options);

  virtual ~MetricsEndpoint() = default;
  virtual int port() const = 0;
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_METRICS_ENDPOINT_H_
