#ifndef DUET_SERVER_METRICS_CALL_RECORD_H_
#define DUET_SERVER_METRICS_CALL_RECORD_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/status.h"

namespace duet::server::metrics {

// A method of the service.
struct MethodInfo {
  std::string_view service;  // "duet.v1.MotionSynthesis"
  std::string_view name;     // "Synthesize"
  std::string_view type;     // "unary" or "server_stream"
};

// The windows of a call.
struct WindowTotals {
  int windows = 0;
  double queue_seconds = 0;
  double compute_seconds = 0;
  int peak_buffered_frames = 0;
};

// Describes a finished call.
struct CallRecord {
  MethodInfo method;
  std::string request_id;
  std::string traceparent;  // W3C trace context; empty if the caller sent none
  std::string peer;
  std::string caller;             // known by token or certificate; empty for an unknown caller
  bool caller_is_listed = false;  // in the access file, which bounds the number of such names

  std::string model;  // empty until a served model is found, which bounds the number of names
  int version = 0;
  std::string_view priority;  // "interactive", "bulk", or empty
  uint64_t seed = 0;
  float variety = 0;
  int candidates = 0;
  bool clean_up = false;

  absl::Status status;  // as sent to the caller
  std::string cause;    // the model's error message, which is not sent to the caller

  int frames = 0;  // sent
  int chunks = 0;
  WindowTotals totals;
  std::optional<double> unfamiliarity;  // of the leader, if the model measures it
  double first_chunk_seconds = -1;      // negative if no chunk was sent
  double total_seconds = 0;
};

// Observes every call. Implemented by the metrics and the log.
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
