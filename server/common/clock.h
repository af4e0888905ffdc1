#ifndef DUET_SERVER_COMMON_CLOCK_H_
#define DUET_SERVER_COMMON_CLOCK_H_

#include <chrono>

namespace duet::server::common {

using TimePoint = std::chrono::steady_clock::time_point;

// Monotonic time, injected so that tests decide what time it is.
//
// Threads: safe to call concurrently.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual TimePoint Now() const = 0;

  // The machine's clock. Lives as long as the process.
  static const Clock& Real();
};

inline double SecondsBetween(TimePoint from, TimePoint to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace duet::server::common

#endif  // DUET_SERVER_COMMON_CLOCK_H_
