#ifndef DUET_SERVER_TRACING_SPAN_H_
#define DUET_SERVER_TRACING_SPAN_H_

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "server/common/trace_context.h"

namespace duet::server::tracing {

using AttributeValue = std::variant<std::string, std::int64_t, double, bool>;

// A finished call. Times are nanoseconds since 1970.
struct Span {
  common::TraceContext trace;
  std::string name;  // "duet.v1.MotionSynthesis/Synthesize"
  std::int64_t start = 0;
  std::int64_t end = 0;
  std::vector<std::pair<std::string, AttributeValue>> attributes;
  std::vector<std::pair<std::int64_t, std::string>> events;  // time, name
  bool failed = false;                                       // by an error of the server
  std::string message;                                       // the error, if failed
};

}  // namespace duet::server::tracing

#endif  // DUET_SERVER_TRACING_SPAN_H_
