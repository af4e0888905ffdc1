#ifndef DUET_SERVER_WATCHDOG_STOP_SIGNAL_H_
#define DUET_SERVER_WATCHDOG_STOP_SIGNAL_H_

#include "server/common/mutex.h"

namespace duet::server::watchdog {

// Signals that arrived and that the main thread has not handled yet: SIGTERM and SIGINT stop the
// server, SIGHUP reloads.
//
// Construct it before any other thread starts, because threads inherit the blocked signals. The
// watchdog's thread receives them and calls Note, so that a signal counts even if the main thread
// hangs.
//
// Threads: safe to call concurrently; one thread waits.
class StopSignal {
 public:
  enum class Kind { kStop, kReload };

  StopSignal();

  // Restores the default action of the signals, for a process that does not drain.
  void Unblock();

  // Records a signal. Reloads that are not handled yet count as one.
  void Note(Kind kind);

  // Waits for a signal and returns its kind. A stop is returned before a reload.
  Kind Wait();
  // Waits at most `seconds` for a stop and returns whether it arrived; 0 only checks. A reload that
  // arrives meanwhile is left for Wait.
  bool WaitFor(double seconds);

 private:
  bool TakeStop() DUET_REQUIRES(mutex_);

  common::Mutex mutex_;
  common::CondVar changed_;
  int stops_ DUET_GUARDED_BY(mutex_) = 0;
  bool reload_ DUET_GUARDED_BY(mutex_) = false;
};

}  // namespace duet::server::watchdog

#endif  // DUET_SERVER_WATCHDOG_STOP_SIGNAL_H_
