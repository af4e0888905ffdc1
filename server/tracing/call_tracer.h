#ifndef DUET_SERVER_TRACING_CALL_TRACER_H_
#define DUET_SERVER_TRACING_CALL_TRACER_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "server/metrics/call_record.h"
#include "server/tracing/span_queue.h"

namespace duet::server::tracing {

// Converts a finished call to a span. Attributes follow OpenTelemetry's conventions for RPCs;
// further ones begin with "duet.".
Span ToSpan(const metrics::CallRecord& record, absl::Time end);

// Sends a span for every call whose trace is sampled.
//
// Threads: safe to call concurrently.
class CallTracer final : public metrics::CallObserver {
 public:
  // Sends to an OpenTelemetry collector. Fails with INVALID_ARGUMENT unless the endpoint is
  // http://HOST:PORT (plain text) or https://HOST:PORT (TLS with the system's authorities).
  static absl::StatusOr<std::unique_ptr<CallTracer>> Open(const std::string& endpoint,
                                                          const std::string& program_version);

  explicit CallTracer(SpanQueue::Options queue, std::function<absl::Time()> now = absl::Now)
      : now_(std::move(now)), queue_(std::move(queue)) {}

  void CallStarted(const metrics::MethodInfo&) override {}
  void CallFinished(const metrics::CallRecord& record) override {
    if (record.trace.sampled) queue_.Add(ToSpan(record, now_()));
  }

  std::uint64_t sent() const { return queue_.sent(); }
  std::uint64_t dropped() const { return queue_.dropped(); }

 private:
  const std::function<absl::Time()> now_;
  SpanQueue queue_;
};

}  // namespace duet::server::tracing

#endif  // DUET_SERVER_TRACING_CALL_TRACER_H_
