#ifndef DUET_SERVER_WATCHDOG_WATCHDOG_H_
#define DUET_SERVER_WATCHDOG_WATCHDOG_H_

#include <pthread.h>

#include <atomic>
#include <thread>

#include "server/common/activity.h"
#include "server/watchdog/step_watch.h"
#include "server/watchdog/stop_signal.h"

namespace duet::server::watchdog {

struct WatchdogOptions {
  // Maximum duration of one bounded step of a thread; 0: no limit.
  double step_seconds = 0;
  // Maximum time to exit after a signal to stop if there are no calls to finish, and after a second
  // signal.
  double hurry_seconds = 10;
  bool text_log = false;  // lines for people instead of JSON
};

// The last resort if a thread hangs: a thread that receives the process's signals and watches the
// steps of the other threads (activity.h). It writes a report to standard error and ends the
// process at once:
//
// - with kExitStuck if a step of a thread takes longer than `step_seconds`;
// - with kExitLate if the process was asked to stop and has not exited in time.
//
// It takes no lock that others hold for longer than a few instructions, and it does not block, not
// even on the reader of standard error.
//
// Threads: safe to call concurrently. Uses neither gRPC nor abseil.
class Watchdog {
 public:
  // `stop` was constructed before any thread, and outlives the watchdog.
  Watchdog(const WatchdogOptions& options, StopSignal& stop);
  // Stops receiving signals. A server's watchdog is never destroyed: it watches until the process
  // has exited.
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  // Sets the maximum time from the first signal to stop until the process exits. The default is
  // hurry_seconds.
  void AllowToStop(double seconds) { stop_seconds_ = seconds; }

 private:
  void Run();
  // Checks every thread and the deadline, `elapsed` seconds after the previous call.
  void Look(double elapsed);
  double PauseSeconds() const;
  void Take(int signal);
  [[noreturn]] void EndStuck();
  [[noreturn]] void EndLate();
  void WriteThread(const char* event, const BusyThread& thread);

  const WatchdogOptions options_;
  StopSignal& stop_;
  std::atomic<double> stop_seconds_;
  std::atomic<bool> ended_{false};

  // Used only by the watchdog's thread.
  common::ThreadStates threads_;
  StepWatch watch_;
  StopDeadline deadline_;

  std::thread thread_;
};

}  // namespace duet::server::watchdog

#endif  // DUET_SERVER_WATCHDOG_WATCHDOG_H_
