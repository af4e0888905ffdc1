#ifndef DUET_CLIENT_LOAD_MEASUREMENT_H_
#define DUET_CLIENT_LOAD_MEASUREMENT_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "client/load/log_histogram.h"
#include "client/load/time.h"

namespace duet::client::load {

// What every distribution is reported at.
struct NamedPercentile {
  absl::string_view name;
  double percent;
};
inline constexpr std::array<NamedPercentile, 9> kPercentiles = {{{"min", 0},
                                                                 {"p1", 1},
                                                                 {"p5", 5},
                                                                 {"p50", 50},
                                                                 {"p90", 90},
                                                                 {"p95", 95},
                                                                 {"p99", 99},
                                                                 {"p99.9", 99.9},
                                                                 {"max", 100}}};

// Calls that were answered. Times are in nanoseconds, from when a call was due, not from when it
// was sent: a generator or a server that falls behind makes no figure better by it (coordinated
// omission).
struct Answered {
  LogHistogram first_chunk;
  LogHistogram whole_call;
  LogHistogram frame_rate;  // frames of a call by the time that it took; millihertz
};

// A stretch of the measured time, by when calls were due.
struct Interval {
  int64_t due = 0;
  int64_t answered = 0;
  int64_t failed = 0;
  LogHistogram whole_call;  // of those that were answered
};

// What is asked of a server at a time: one of the two.
struct Step {
  int callers = 0;     // closed loop: so many, each of which asks again once it is answered
  double rate_hz = 0;  // open loop: so many calls a second, whatever becomes of them
};

// A call that has ended, for who keeps a record of each.
struct CallRecord {
  Duration due;      // from the start of the measured time; negative while warming up
  Duration late;     // from when it was due to when it was sent
  Duration elapsed;  // from when it was due to its end
  std::optional<Duration> first_chunk;  // from when it was due
  std::size_t kind = 0;
  absl::StatusCode code = absl::StatusCode::kOk;
  int frames = 0;
};

// What became of the calls of a step that were due in its measured time.
struct Measurement {
  Step step;
  double began_unix = 0;  // measuring, in seconds since 1970; set by who knows the date
  double seconds = 0;     // measured
  int64_t due = 0;        // calls that ought to have been sent
  int64_t sent = 0;       // calls that were; the rest had to wait for others to end, to the last
  LogHistogram late;      // nanoseconds from when calls were due to when they were sent
  Answered all;           // of every kind
  std::vector<Answered> by_kind;
  // Of every call, by how it ended; nanoseconds from when it was due.
  std::map<absl::StatusCode, LogHistogram> ended;
  // Within the measured time, whenever they were due.
  int64_t answered_in_time = 0;
  int64_t frames_in_time = 0;
  Duration interval_length{0};
  std::vector<Interval> timeline;
  std::map<absl::StatusCode, int64_t> background;  // calls that were load alone

  int64_t answered() const { return all.whole_call.count(); }
  double answered_per_second() const;
  double frames_per_second() const;
  double due_per_second() const;
  double sent_per_second() const;
};

// Whether the generator did what it was asked to: all calls were sent, and no more than one in a
// hundred over 10 ms late. Where it did not, the figures tell of the generator as well as of the
// server.
bool KeptUp(const Measurement& measurement);

// Calls that ended in any way but well, together.
LogHistogram NotAnswered(const Measurement& measurement);

}  // namespace duet::client::load

#endif  // DUET_CLIENT_LOAD_MEASUREMENT_H_
