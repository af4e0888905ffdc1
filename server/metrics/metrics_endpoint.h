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
  std::function<std::string()> render;  // the Prometheus text; called concurrently
  std::function<bool()> ready;          // whether calls are being served
  // How it stands in detail, for people: lines. May be empty; called concurrently.
  std::function<std::string()> describe;
};

// A small HTTP server beside gRPC: GET /metrics for Prometheus, /healthz (200 while the process
// answers) and /readyz (200 while calls are served, else 503; the text says how it stands).
//
// Not prometheus::Exposer: its threads have 100 kB stacks, which do not hold the static thread
// storage of OpenBLAS and LibTorch, so that it throws in a server that has loaded them.
class MetricsEndpoint {
 public:
  // Fails with UNAVAILABLE naming the address when it cannot be listened on.
  static absl::StatusOr<std::unique_ptr<MetricsEndpoint>> Start(MetricsEndpointOptions options);

  virtual ~MetricsEndpoint() = default;
  virtual int port() const = 0;
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_METRICS_ENDPOINT_H_
