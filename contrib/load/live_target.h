#ifndef DUET_CONTRIB_LOAD_LIVE_TARGET_H_
#define DUET_CONTRIB_LOAD_LIVE_TARGET_H_

#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "contrib/load/time.h"

namespace duet::contrib::load {

// How a session ended.
struct EndedSession {
  absl::StatusCode code = absl::StatusCode::kOk;  // INTERNAL for a stream without a summary
  // What the server counted in its summary.
  int skipped_frames = 0, gap_frames = 0, late_frames = 0;
};

// What arrived of a session: final frames, or its end.
struct LiveEvent {
  int session = 0;
  Time time;
  int first_frame = 0, frames = 0;
  double server_seconds = 0;  // the newest leader frame of the message was at the server
  std::optional<EndedSession> ended;
};

// The destination of live sessions and the source of time. Tests use a simulated server.
//
// Threads: not thread-safe.
class LiveTarget {
 public:
  virtual ~LiveTarget() = default;

  virtual Time Now() const = 0;
  // Opens a session without waiting for it. Every session ends exactly once, and nothing arrives
  // after its end. The caller chooses `session`.
  virtual void Open(int session) = 0;
  // Sends a leader frame. Does nothing if the session has ended.
  virtual void Send(int session, int frame) = 0;
  // Sends no more frames; the session ends when the server has answered all of them.
  virtual void Finish(int session) = 0;
  // Waits until `until` or until something has arrived, whichever is first. Returns what no earlier
  // Wait returned; of each session in the order of its arrival.
  virtual std::vector<LiveEvent> Wait(Time until) = 0;
  // Cancels all open sessions; Wait returns their ends too.
  virtual void CancelAll() = 0;
};

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_LIVE_TARGET_H_
