#ifndef DUET_SERVER_METRICS_CALL_LOG_FILTER_H_
#define DUET_SERVER_METRICS_CALL_LOG_FILTER_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "server/common/mutex.h"

namespace duet::server::metrics {

// Decides which calls are logged, so that neither a busy server nor a flood of rejected calls fills
// the disk: a fraction of the successful calls, and a number of rejected calls per second and
// status code. It counts the rejected calls that are not logged.
//
// Threads: safe to call concurrently. Uses neither gRPC nor abseil.
class CallLogFilter {
 public:
  // The code for messages of libraries: that of OK, which is never rejected.
  static constexpr int kLibraries = 0;

  // Calls of one status code that were not logged.
  struct Unlogged {
    int code = 0;
    std::uint64_t calls = 0;
  };

  // `success_ratio`: fraction of successful calls, 0 to 1. `refusals_per_second`: at least 0.
  CallLogFilter(double success_ratio, int refusals_per_second)
      : success_ratio_(success_ratio), refusals_per_second_(refusals_per_second) {}

  // Whether to log a successful call. Logged calls are evenly spread and include the first, unless
  // none are logged.
  bool LogSuccess();
  // Whether to log a rejected call. `code`: a gRPC status code, 1 to 16, or kLibraries; `now`: in
  // seconds.
  bool LogRefusal(int code, double now);

  // Returns how many rejected calls were not logged since the previous call of this function, by
  // code.
  std::vector<Unlogged> TakeUnlogged();

 private:
  static constexpr std::size_t kCodes = 17;
  struct Second {
    double begin = 0;
    int logged = 0;
    std::uint64_t unlogged = 0;
  };

  const double success_ratio_;
  const int refusals_per_second_;
  common::Mutex mutex_;
  double successes_ DUET_GUARDED_BY(mutex_) = 1;  // credit of successful calls, in lines
  std::array<Second, kCodes> seconds_ DUET_GUARDED_BY(mutex_);
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_CALL_LOG_FILTER_H_
