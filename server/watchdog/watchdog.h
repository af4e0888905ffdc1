#ifndef DUET_SERVER_WATCHDOG_WATCHDOG_H_
#define DUET_SERVER_WATCHDOG_WATCHDOG_H_

#include <pthread.h>

#include <atomic>
#include <thread>

#include "server/common/activity.h"
#include "server/watchdog/step_watch.h"
#include "server/watchdog/stop_deadline.h"
#include "server/watchdog/stop_signal.h"

namespace duet::server::watchdog {

struct WatchdogOptions {
  // How long a thread may take for one bounded step; 0: for ever.
  double step_seconds = 0;
  // How long the process may take to end once it was asked to and has no calls to finish, or once
  // it was asked a second time.
  double hurry_seconds = 10;
  bool text_log = false;  // lines for people instead of JSON
};

// The last resort when a thread never returns: a thread that takes the process's signals, watches
// what the others do (activity.h) and, when nothing else helps, writes to standard error how things
// stand and ends the process at once:
//
// - with kExitStuck when a thread takes longer than `step_seconds` for a step;
// - with kExitLate when the process was asked to stop and has not ended in time.
//
// It takes no lock that others hold for longer than a few instructions and waits for nobody, not
// even for the reader of standard error.
// Threads: safe to call concurrently. Uses neither gRPC nor abseil.
class Watchdog {
 public:
  // `stop` was constructed before any thread, and outlives the watchdog.
  Watchdog(const WatchdogOptions& options, StopSignal& stop);
  // Takes no more signals. A server's watchdog is never destroyed: it watches until the process is
  // gone.
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  // How long the process may take to end from its first signal to stop on. Until this is called:
  // hurry_seconds.
  void AllowToStop(double seconds) { stop_seconds_ = seconds; }

 private:
  void Run();
  // Looks at everything, `elapsed` seconds after the last time.
  void Look(double elapsed);
  double PauseSeconds() const;
  void Take(int signal);
  [[noreturn]] void EndStuck();
  [[noreturn]] void EndLate();
  void WriteThread(const char* event, const BusyThread& thread) const;

  const WatchdogOptions options_;
  StopSignal& stop_;
  std::atomic<double> stop_seconds_;
  std::atomic<bool> ended_{false};

  // Of the watchdog's own thread.
  common::ThreadStates threads_;
  StepWatch watch_;
  StopDeadline deadline_;

  std::thread thread_;
};

}  // namespace duet::server::watchdog

#endif  // DUET_SERVER_WATCHDOG_WATCHDOG_H_
