#ifndef DUET_TESTS_SERVER_SUPPORT_FAKE_CLOCK_H_
#define DUET_TESTS_SERVER_SUPPORT_FAKE_CLOCK_H_

#include <atomic>
#include <chrono>

#include "server/common/clock.h"

namespace duet::test {

// A clock that only the test advances.
//
// Threads: safe to call concurrently.
class FakeClock final : public server::common::Clock {
 public:
  server::common::TimePoint Now() const override { return server::common::TimePoint(now_.load()); }
  void Advance(std::chrono::milliseconds by) { now_ = now_.load() + by; }

 private:
  std::atomic<server::common::TimePoint::duration> now_{std::chrono::hours(1)};
};

}  // namespace duet::test

#endif  // DUET_TESTS_SERVER_SUPPORT_FAKE_CLOCK_H_
