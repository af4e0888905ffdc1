#ifndef DUET_SERVER_WATCHDOG_STOP_SIGNAL_H_
#define DUET_SERVER_WATCHDOG_STOP_SIGNAL_H_

#include "server/common/mutex.h"

namespace duet::server::watchdog {

// The signals that came and that the main thread has not heeded yet: SIGTERM and SIGINT, which
// stop, and SIGHUP, which reloads.
//
// Construct it before any other thread starts: threads inherit that the signals are blocked. The
// watchdog's thread takes them and calls Note, so that a signal is noticed even if the main thread
// never returns.
// Threads: safe to call concurrently; one thread waits.
class StopSignal {
 public:
  enum class Kind { kStop, kReload };

  StopSignal();

  // Lets the signals end the process as they do by default: for a process that is not to drain.
  void Unblock();

  // A signal came. Reloads that nobody has heeded yet count as one.
  void Note(Kind kind);

  // Waits until a signal came, and returns which. Of several that came before, one that stops is
  // first.
  Kind Wait();
  // Waits for one that stops for at most `seconds`. True when it came; 0 just looks. A reload that
  // is asked for meanwhile waits for Wait.
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
