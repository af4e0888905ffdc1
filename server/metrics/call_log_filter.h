#ifndef DUET_SERVER_METRICS_CALL_LOG_FILTER_H_
#define DUET_SERVER_METRICS_CALL_LOG_FILTER_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "server/common/mutex.h"

namespace duet::server::metrics {

// Decides which rejected calls are logged, so that a flood of them does not fill the disk: a number
// per second and status code. It counts the others.
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

  // `refusals_per_second`: at least 0.
  explicit CallLogFilter(int refusals_per_second) : refusals_per_second_(refusals_per_second) {}

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

  const int refusals_per_second_;
  common::Mutex mutex_;
  std::array<Second, kCodes> seconds_ DUET_GUARDED_BY(mutex_);
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_CALL_LOG_FILTER_H_
