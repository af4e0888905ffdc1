#ifndef DUET_SERVER_METRICS_METRICS_ENDPOINT_H_
#define DUET_SERVER_METRICS_METRICS_ENDPOINT_H_

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace duet::server::metrics {

struct MetricsEndpointOptions {
  std::string host;
  int port = 0;                         // 0: any free one
  std::function<std::string()> render;  // the Prometheus text
  std::function<bool()> healthy;        // whether the server is still reachable
  std::function<bool()> ready;          // whether calls are being served
  // Maximum duration of a connection, from accept to close, and maximum number of connections. A
  // new connection replaces the oldest.
  double connection_seconds = 5;
  std::size_t max_connections = 256;
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

  virtual ~MetricsEndpoint() = default;
  virtual int port() const = 0;
};

// The content of one page of the endpoint.
struct HttpPage {
  bool is_good = true;  // status 200, otherwise 503
  std::string content_type = "text/plain";
  std::string body;
};

// Path -> function that makes the page.
using HttpPages = std::map<std::string, std::function<HttpPage()>, std::less<>>;

// The largest head of a request, in bytes.
inline constexpr std::size_t kMaxHttpHeadBytes = 8192;

// Returns the whole response (RFC 9112) to what a client has sent so far, or nullopt while the head
// of its request is incomplete. Serves GET and HEAD of known pages; anything else gets 400, 404,
// 405 or 431. Request bodies are not read. The connection ends with the response.
std::optional<std::string> HttpReply(std::string_view received, const HttpPages& pages);

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_METRICS_ENDPOINT_H_
