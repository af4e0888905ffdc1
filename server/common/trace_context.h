#ifndef DUET_SERVER_COMMON_TRACE_CONTEXT_H_
#define DUET_SERVER_COMMON_TRACE_CONTEXT_H_

#include <optional>
#include <string>
#include <string_view>

namespace duet::server::common {

// A call's place in a trace, as in W3C Trace Context. Identifiers are lower-case hex.
struct TraceContext {
  std::string trace_id;        // 32 characters; empty: no trace
  std::string span_id;         // 16 characters; this call's
  std::string parent_span_id;  // the caller's; empty for the first span of a trace
  bool sampled = false;        // whether spans of the trace are recorded
};

// Parses a `traceparent`. Returns nullopt unless it is well formed, of version 00, and its
// identifiers are not all zeros. The caller's span is the parent; span_id is new.
std::optional<TraceContext> ContinueTrace(std::string_view traceparent);

// Begins a new trace. A fraction `ratio`, 0 to 1, of all such traces is sampled. The trace id
// decides, so that servers with the same ratio agree.
TraceContext BeginTrace(double ratio);

// Returns the `traceparent` with span_id; empty if there is no trace.
std::string Traceparent(const TraceContext& context);

}  // namespace duet::server::common

#endif  // DUET_SERVER_COMMON_TRACE_CONTEXT_H_
