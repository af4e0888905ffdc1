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
  // `endpoint`: "http://HOST:PORT" in plain text, "https://HOST:PORT" encrypted, trusting the
  // system's authorities. Does not connect yet. INVALID_ARGUMENT for anything else.
  static absl::StatusOr<std::unique_ptr<OtlpClient>> Create(const std::string& endpoint,
                                                            const std::string& program_version);
  virtual ~OtlpClient() = default;

  // Waits for at most a few seconds. The collector's status.
  virtual absl::Status Send(const std::vector<Span>& spans) = 0;
};

}  // namespace duet::server::tracing

#endif  // DUET_SERVER_TRACING_OTLP_CLIENT_H_
