#ifndef DUET_SERVER_METRICS_CALL_RECORD_H_
#define DUET_SERVER_METRICS_CALL_RECORD_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "server/common/trace_context.h"

namespace duet::server::metrics {

// A method of the service.
struct MethodInfo {
  std::string_view service;  // "duet.v1.MotionSynthesis"
  std::string_view name;     // "Synthesize"
  std::string_view type;     // "unary" or "server_stream"
};

// Everything worth knowing of one call once it is over.
struct CallRecord {
  MethodInfo method;
  std::string request_id;
  std::string traceparent;     // W3C trace context, empty when the caller sent none
  common::TraceContext trace;  // of this call in it, or in a trace begun here
  std::string peer;
  std::string caller;             // by its token or certificate; empty for somebody unknown
  bool caller_is_listed = false;  // in the access file, so that such names are few

  std::string model;  // empty until a served model was found: bounded by what is served
  int version = 0;
  std::string_view priority;  // "interactive", "bulk", or empty
  uint64_t seed = 0;
  float variety = 0;
  bool clean_up = false;

  absl::Status status;  // what the caller was told
  std::string cause;    // what the caller was not told: the model's own words

  int frames = 0;  // sent
  int chunks = 0;
  int windows = 0;
  int peak_buffered_frames = 0;
  std::optional<double> unfamiliarity;  // of the request to its model, where that knows
  double first_chunk_seconds = -1;      // negative when no chunk was sent
  double queue_seconds = 0;
  double compute_seconds = 0;
  double total_seconds = 0;
};

// Told of every call. Metrics and the log are two of them.
//
// Threads: called concurrently. Must neither block nor throw.
class CallObserver {
 public:
  virtual ~CallObserver() = default;
  virtual void CallStarted(const MethodInfo& method) = 0;
  virtual void CallFinished(const CallRecord& record) = 0;
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_CALL_RECORD_H_
