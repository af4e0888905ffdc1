#ifndef DUET_SERVER_COMMON_CLOCK_H_
#define DUET_SERVER_COMMON_CLOCK_H_

#include <chrono>

namespace duet::server::common {

using TimePoint = std::chrono::steady_clock::time_point;

// Monotonic time. It is injected, so that tests control it.
//
// Threads: safe to call concurrently.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual TimePoint Now() const = 0;

  // The system's clock. Lives as long as the process.
  static const Clock& Real();
};

inline const Clock& Clock::Real() {
  class RealClock final : public Clock {
    TimePoint Now() const override { return std::chrono::steady_clock::now(); }
  };
  static const RealClock clock;
  return clock;
}

inline TimePoint::duration Seconds(double seconds) {
  return std::chrono::duration_cast<TimePoint::duration>(std::chrono::duration<double>(seconds));
}

inline double SecondsBetween(TimePoint from, TimePoint to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace duet::server::common

#endif  // DUET_SERVER_COMMON_CLOCK_H_
