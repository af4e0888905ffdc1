#ifndef DUET_SERVER_WATCHDOG_STEP_WATCH_H_
#define DUET_SERVER_WATCHDOG_STEP_WATCH_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "server/common/activity.h"

namespace duet::server::watchdog {

// A thread that is not idle, and how long its current step has taken.
struct BusyThread {
  pid_t thread_id = 0;
  const common::StepKind* step = nullptr;
  double seconds = 0;
};

// Measures how long each thread has been at its current step. Counts only the time that its caller
// passes in, so that a process that is paused as a whole (SIGSTOP, a frozen container) has no stuck
// threads.
//
// Threads: not safe to call concurrently. Allocates no memory after construction.
class StepWatch {
 public:
  // `elapsed`: seconds since the previous call. A step that began since then counts 0 seconds.
  void Look(const common::ThreadStates& threads, double elapsed);

  // Returns the thread whose bounded step has taken longest, or an idle one (null step) if none.
  BusyThread longest() const;

  // Calls `visit(const BusyThread&)` for each thread whose step has taken at least `seconds`. Skips
  // unbounded steps unless `every` is true.
  template <typename Visit>
  void ForEach(double seconds, bool every, const Visit& visit) const {
    for (const Watched& thread : watched_) {
      const BusyThread& busy = thread.busy;
      if (busy.step == nullptr || busy.seconds < seconds) continue;
      if (every || busy.step->is_bounded) visit(busy);
    }
  }

 private:
  struct Watched {
    BusyThread busy;
    std::uint64_t beat = 0;
  };

  std::array<Watched, common::kMaxThreads> watched_;
};

// Decides whether a process that was asked to stop should have exited by now.
//
// Threads: not safe to call concurrently.
class StopDeadline {
 public:
  // Records a signal to stop.
  void Asked() { ++signals_; }
  void Pass(double seconds) {
    if (signals_ >= 1) since_first_ += seconds;
    if (signals_ >= 2) since_second_ += seconds;
  }

  bool asked() const { return signals_ > 0; }
  // The process has `stop_seconds` from the first signal, and at most `hurry_seconds` from the
  // second.
  bool IsOver(double stop_seconds, double hurry_seconds) const {
    return (signals_ >= 1 && since_first_ >= stop_seconds) ||
           (signals_ >= 2 && since_second_ >= hurry_seconds);
  }

 private:
  int signals_ = 0;
  double since_first_ = 0;
  double since_second_ = 0;
};

}  // namespace duet::server::watchdog

#endif  // DUET_SERVER_WATCHDOG_STEP_WATCH_H_
