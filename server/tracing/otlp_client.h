#ifndef DUET_SERVER_TRACING_OTLP_CLIENT_H_
#define DUET_SERVER_TRACING_OTLP_CLIENT_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/tracing/span.h"

namespace duet::server::tracing {

// Sends spans to an OpenTelemetry collector: OTLP over gRPC.
//
// Threads: one thread at a time.
class OtlpClient {
 public:
  // `endpoint`: "http://HOST:PORT" for plain text, "https://HOST:PORT" for TLS with the system's
  // authorities. Does not connect yet. Fails with INVALID_ARGUMENT for any other endpoint.
  static absl::StatusOr<std::unique_ptr<OtlpClient>> Create(const std::string& endpoint,
                                                            const std::string& program_version);
  virtual ~OtlpClient() = default;

  // Waits at most a few seconds. Returns the collector's status.
  virtual absl::Status Send(const std::vector<Span>& spans) = 0;
};

}  // namespace duet::server::tracing

#endif  // DUET_SERVER_TRACING_OTLP_CLIENT_H_
