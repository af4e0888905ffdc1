#ifndef DUET_SERVER_COMMON_TRACE_CONTEXT_H_
#define DUET_SERVER_COMMON_TRACE_CONTEXT_H_

#include <optional>
#include <string>
#include <string_view>

namespace duet::server::common {

// A call's place in a trace, as the W3C's Trace Context has it. Identifiers are lower-case hex.
struct TraceContext {
  std::string trace_id;        // 32 characters; empty: no trace
  std::string span_id;         // 16 characters, of what goes on here
  std::string parent_span_id;  // the caller's; empty for the first of a trace
  bool sampled = false;        // whether spans of the trace are recorded
};

// Reads a `traceparent`: nothing unless it is version 00 and well formed, with identifiers that are
// not all zeros. The caller's span is the parent; span_id is new.
std::optional<TraceContext> ContinueTrace(std::string_view traceparent);

// A trace of its own. `ratio`, 0 to 1, of all such traces are sampled: decided by the trace id, so
// that servers with the same ratio agree.
TraceContext BeginTrace(double ratio);

// The `traceparent` that names span_id; empty for no trace.
std::string Traceparent(const TraceContext& context);

}  // namespace duet::server::common

#endif  // DUET_SERVER_COMMON_TRACE_CONTEXT_H_
