#ifndef DUET_CONTRIB_LOAD_CALLS_H_
#define DUET_CONTRIB_LOAD_CALLS_H_

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "contrib/load/figures.h"

namespace duet::contrib::load {

// How a call ended.
struct EndedCall {
  int64_t id = 0;
  absl::StatusCode code = absl::StatusCode::kOk;
  std::optional<Time> first_chunk;  // arrival of its first frames
  Time end;
  int frames = 0;  // received
};

// The destination of calls and the source of time. Tests use a simulated server, which makes a run
// of minutes repeatable.
//
// Threads: not thread-safe.
class CallTarget {
 public:
  virtual ~CallTarget() = default;

  virtual Time Now() const = 0;
  // Begins a call without waiting for it. Every call ends exactly once. The caller chooses `id`.
  virtual void Start(int64_t id) = 0;
  // Waits until `until` or until calls have ended, whichever is first. Returns the ended calls that
  // no earlier Wait returned.
  virtual std::vector<EndedCall> Wait(Time until) = 0;
};

// The load of a step: exactly one of the two.
struct CallLoad {
  int callers = 0;     // closed loop: callers that call again after each answer
  double rate_hz = 0;  // open loop: calls a second, at random times independent of the answers
};

struct CallOptions {
  Duration warm_up = std::chrono::seconds(1);  // calls that are due before its end are not measured
  Duration measured = std::chrono::seconds(10);
  // In an open loop: the most calls in flight. Calls due beyond that are sent late and measured
  // from their due time.
  int max_in_flight = 4096;
  // Polled: after it returns true no further call is sent, and only the calls sent until then are
  // measured. Optional.
  std::function<bool()> stopped;
};

// The results of the calls of a step that were due in its measured time. Times run from when a call
// was due, not from when it was sent: otherwise a generator or a server that falls behind would
// improve the figures (coordinated omission).
struct CallFigures {
  CallLoad load;
  double seconds = 0;  // measured
  int64_t due = 0;     // calls that were due
  int64_t sent = 0;    // calls that were sent; the others waited until the end for a free place
  Times late;          // from when calls were due to when they were sent
  Times first_chunk, whole_call;            // of answered calls
  std::map<absl::StatusCode, Times> ended;  // of every call, by status
  // Ended within the measured time, including calls due before it.
  int64_t answered_in_time = 0, frames_in_time = 0;

  double answered_per_second() const;
  double frames_per_second() const;
  bool kept_up() const { return sent == due && late.Ms(99) <= kLateMs; }
};

// Puts a load on a target. Returns after every call has ended.
//
// Closed loop: a call is due when its caller's previous one has ended. Open loop: a pause of the
// server delays every call that is due in it.
CallFigures RunCalls(const CallLoad& load, const CallOptions& options, CallTarget& target);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_CALLS_H_
