#ifndef DUET_CONTRIB_LOAD_MEASUREMENT_H_
#define DUET_CONTRIB_LOAD_MEASUREMENT_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "contrib/load/log_histogram.h"
#include "contrib/load/time.h"

namespace duet::contrib::load {

// The reported percentiles of every distribution.
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

// Answered calls. Times are in nanoseconds from when a call was due, not from when it was sent:
// otherwise a generator or a server that falls behind would improve the figures (coordinated
// omission).
struct Answered {
  LogHistogram first_chunk;
  LogHistogram whole_call;
  LogHistogram frame_rate;  // frames of a call divided by its time; millihertz
};

// An interval of the measured time, with the calls that were due in it.
struct Interval {
  int64_t due = 0;
  int64_t answered = 0;
  int64_t failed = 0;
  LogHistogram whole_call;  // of answered calls
};

// The load of a step: exactly one of the two.
struct Step {
  int callers = 0;     // closed loop: callers that call again after each answer
  double rate_hz = 0;  // open loop: calls a second, independent of the answers
};

// A call that has ended.
struct CallRecord {
  Duration due;      // from the start of the measured time; negative while warming up
  Duration late;     // from when it was due to when it was sent
  Duration elapsed;  // from when it was due to its end
  std::optional<Duration> first_chunk;  // from when it was due
  std::size_t kind = 0;
  absl::StatusCode code = absl::StatusCode::kOk;
  int frames = 0;
};

// The results of the calls of a step that were due in its measured time.
struct Measurement {
  Step step;
  double began_unix = 0;  // start of measuring, in seconds since 1970; set by the caller
  double seconds = 0;     // measured
  int64_t due = 0;        // calls that were due
  int64_t sent = 0;       // calls that were sent; the others waited until the end for a free place
  LogHistogram late;      // nanoseconds from when calls were due to when they were sent
  Answered all;           // of every kind
  std::vector<Answered> by_kind;
  // Of every call, by status; nanoseconds from when it was due.
  std::map<absl::StatusCode, LogHistogram> ended;
  // Ended within the measured time, including calls due before it.
  int64_t answered_in_time = 0;
  int64_t frames_in_time = 0;
  Duration interval_length{0};
  std::vector<Interval> timeline;
  std::map<absl::StatusCode, int64_t> background;  // background calls

  int64_t answered() const { return all.whole_call.count(); }
  double answered_per_second() const;
  double frames_per_second() const;
  double due_per_second() const;
  double sent_per_second() const;
};

// Whether the generator kept up: all calls were sent, and at most one in a hundred over 10 ms late.
// Otherwise the figures also measure the generator.
bool KeptUp(const Measurement& measurement);

// All calls that ended with an error.
LogHistogram NotAnswered(const Measurement& measurement);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_MEASUREMENT_H_
