#ifndef DUET_SERVER_METRICS_CALL_LOG_FILTER_H_
#define DUET_SERVER_METRICS_CALL_LOG_FILTER_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "server/common/mutex.h"

namespace duet::server::metrics {

// Which calls get a line in the log, so that neither a busy server nor a flood of refused calls
// fills the disk: of successes a part, of refusals so many a second and status code; of the others
// how many there were.
//
// Threads: safe to call concurrently. Uses neither gRPC nor abseil.
class CallLogFilter {
 public:
  // Stands among the codes for what libraries have to say; a success is never refused.
  static constexpr int kLibraries = 0;

  // Calls of one status code that got no line.
  struct Unlogged {
    int code = 0;
    std::uint64_t calls = 0;
  };

  // `success_ratio`: 0 to 1, of successful calls. `refusals_per_second`: 0 or more.
  CallLogFilter(double success_ratio, int refusals_per_second)
      : success_ratio_(success_ratio), refusals_per_second_(refusals_per_second) {}

  // Whether a successful call gets a line: evenly spread, the first one does unless none do.
  bool LogSuccess();
  // Whether a refused call does. `code`: a gRPC status code, 1 to 16, or kLibraries; `now`: in
  // seconds.
  bool LogRefusal(int code, double now);

  // How many refused calls got no line since this was asked last, by code.
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
  double successes_ DUET_GUARDED_BY(mutex_) = 1;  // lines that successes have earned
  std::array<Second, kCodes> seconds_ DUET_GUARDED_BY(mutex_);
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_CALL_LOG_FILTER_H_
