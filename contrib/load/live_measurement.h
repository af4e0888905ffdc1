#ifndef DUET_CONTRIB_LOAD_LIVE_MEASUREMENT_H_
#define DUET_CONTRIB_LOAD_LIVE_MEASUREMENT_H_

#include <cstdint>
#include <map>
#include <vector>

#include "absl/status/status.h"
#include "contrib/load/log_histogram.h"
#include "contrib/load/time.h"

namespace duet::contrib::load {

// A follower frame is late if it arrives more than one frame after its leader frame was due to be
// sent, and missed if it arrives after this time or never: a viewer has shown the plan instead.
inline constexpr Duration kMissedAfter = std::chrono::milliseconds(100);

// An interval of the measured time, with the frames that were due in it.
struct LiveInterval {
  int64_t sent = 0;
  int64_t late = 0;
  int64_t missed = 0;
  LogHistogram latency;
};

// The results of live sessions side by side. Frames are those that were sent in the measured time;
// times are in nanoseconds from when a leader frame was due to be sent to the arrival of the final
// follower frame of the same instant.
struct LiveMeasurement {
  int sessions = 0;
  double frame_rate_hz = 0;
  double began_unix = 0;  // start of measuring, in seconds since 1970; set by the caller
  double seconds = 0;     // measured
  int64_t sent = 0;       // leader frames, without those that were lost on purpose
  int64_t answered = 0;
  LogHistogram late_sent;  // from when frames were due to when they were sent
  LogHistogram latency;
  LogHistogram at_server;    // of the newest leader frame of each message, as the server says
  LogHistogram first_frame;  // of each session, from its opening to its first final frame
  int64_t late = 0;
  int64_t missed = 0;
  // Of whole sessions, warm-up included. Lost: final frames that never came; doubled: that came
  // again. Both are defects of the server.
  int64_t lost = 0, doubled = 0;
  // What the servers counted in their summaries.
  int64_t skipped = 0, interpolated = 0, dropped = 0;
  std::map<absl::StatusCode, int64_t> ended;  // sessions by status
  int64_t refused = 0;                        // sessions that ended with an error before any frame
  Duration interval_length{0};
  std::vector<LiveInterval> timeline;
};

// Whether the generator kept up: at most one frame in a hundred was sent over 10 ms late. Otherwise
// the figures also measure the generator.
bool KeptUp(const LiveMeasurement& measurement);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_LIVE_MEASUREMENT_H_
