#include "server/tracing/call_tracer.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "server/tracing/otlp_client.h"

namespace duet::server::tracing {
namespace {

// The codes that OpenTelemetry counts as errors of the server; the others are the caller's.
bool IsServersFault(absl::StatusCode code) {
  switch (code) {
    case absl::StatusCode::kUnknown:
    case absl::StatusCode::kDeadlineExceeded:
    case absl::StatusCode::kUnimplemented:
    case absl::StatusCode::kInternal:
    case absl::StatusCode::kUnavailable:
    case absl::StatusCode::kDataLoss:
      return true;
    default:
      return false;
  }
}

}  // namespace

Span ToSpan(const metrics::CallRecord& record, absl::Time end) {
  Span span;
  span.trace = record.trace;
  span.name = std::string(record.method.service) + "/" + std::string(record.method.name);
  span.end = absl::ToUnixNanos(end);
  span.start = absl::ToUnixNanos(end - absl::Seconds(record.total_seconds));
  const auto add = [&span](const char* key, AttributeValue value) {
    span.attributes.emplace_back(key, std::move(value));
  };
  add("rpc.system", std::string("grpc"));
  add("rpc.service", std::string(record.method.service));
  add("rpc.method", std::string(record.method.name));
  add("rpc.grpc.status_code", static_cast<std::int64_t>(record.status.code()));
  add("duet.request_id", record.request_id);
  if (!record.caller.empty()) add("duet.caller", record.caller);
  if (!record.model.empty()) {
    add("duet.model", record.model);
    add("duet.version", std::int64_t{record.version});
  }
  if (!record.priority.empty()) {
    add("duet.priority", std::string(record.priority));
    add("duet.frames", std::int64_t{record.frames});
    add("duet.windows", std::int64_t{record.windows});
    add("duet.queue_seconds", record.queue_seconds);
    add("duet.compute_seconds", record.compute_seconds);
  }
  if (record.first_chunk_seconds >= 0) {
    span.events.emplace_back(
        span.start + absl::ToInt64Nanoseconds(absl::Seconds(record.first_chunk_seconds)),
        "first_chunk");
  }
  span.failed = IsServersFault(record.status.code());
  if (span.failed) span.message = std::string(record.status.message());
  return span;
}

absl::StatusOr<std::unique_ptr<CallTracer>> CallTracer::Open(const std::string& endpoint,
                                                             const std::string& program_version) {
  absl::StatusOr<std::unique_ptr<OtlpClient>> client =
      OtlpClient::Create(endpoint, program_version);
  if (!client.ok()) return client.status();
  SpanQueue::Options queue;
  queue.send = [collector = std::shared_ptr<OtlpClient>(*std::move(client))](
                   const std::vector<Span>& spans) { return collector->Send(spans).ok(); };
  return std::make_unique<CallTracer>(std::move(queue));
}

}  // namespace duet::server::tracing
