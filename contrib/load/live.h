#ifndef DUET_CONTRIB_LOAD_LIVE_H_
#define DUET_CONTRIB_LOAD_LIVE_H_

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "contrib/load/figures.h"

namespace duet::contrib::load {

// How a session ended.
struct EndedSession {
  absl::StatusCode code = absl::StatusCode::kOk;  // INTERNAL for a stream without a summary
  int skipped_frames = 0;                         // as the server's summary says
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

// Live sessions that run side by side.
struct LiveOptions {
  int sessions = 1;
  double frame_rate_hz = 30;
  Duration warm_up = std::chrono::seconds(1);  // frames due before its end are not measured
  Duration measured = std::chrono::seconds(10);
  // Polled: after it returns true no further frame is sent. Optional.
  std::function<bool()> stopped;
};

// When a session opens and sends its first frame. Sessions open one after another within a second,
// with their frames spread evenly over the interval between two frames, as those of independent
// people are.
Time OpeningOf(const LiveOptions& options, int session, Time begin);

// The results of live sessions side by side. Frames are those that were sent in the measured time;
// times run from when a leader frame was due to be sent to the arrival of the final follower frame
// of the same instant.
struct LiveFigures {
  int sessions = 0;
  double seconds = 0;  // measured
  int64_t sent = 0;    // leader frames
  int64_t answered = 0;
  Times late_sent;  // from when frames were due to when they were sent
  Times latency;
  Times at_server;    // of the newest leader frame of each message, as the server says
  Times first_frame;  // of each session, from its opening to its first final frame
  // Frames that arrived more than one frame after they were due; and those that arrived after 100
  // ms or never: a viewer has shown the plan instead.
  int64_t late = 0, missed = 0;
  // Of whole sessions, warm-up included. Lost: final frames that never came; doubled: that came
  // again. Both are defects of the server.
  int64_t lost = 0, doubled = 0;
  int64_t skipped = 0;                        // as the servers' summaries say
  std::map<absl::StatusCode, int64_t> ended;  // sessions by status
  int64_t refused = 0;                        // sessions that ended with an error before any frame

  bool kept_up() const { return late_sent.Ms(99) <= kLateMs; }
};

// Runs live sessions side by side for the warm-up and the measured time. Frames are due when a
// camera would deliver them, whether or not the server answers. Returns after every session has
// ended.
LiveFigures RunLive(const LiveOptions& options, LiveTarget& target);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_LIVE_H_
