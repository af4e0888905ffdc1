#ifndef DUET_SERVER_LIFECYCLE_STOP_SIGNAL_H_
#define DUET_SERVER_LIFECYCLE_STOP_SIGNAL_H_

namespace duet::server::lifecycle {

// Waits for SIGTERM and SIGINT, which stop, and SIGHUP, which reloads, without signal handlers.
//
// Construct it before any other thread starts: threads inherit that the signals are blocked, and
// then only Wait sees them, even while models are being loaded.
// Threads: one thread waits.
class StopSignal {
 public:
  enum class Kind { kStop, kReload };

  StopSignal();

  // Waits until a signal came, and says which. Of several that came before, one that stops is
  // first.
  Kind Wait();
  // Waits for one that stops for at most `seconds`. True when it came; 0 just looks. A reload that
  // is asked for meanwhile waits for Wait.
  bool WaitFor(double seconds);
};

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_STOP_SIGNAL_H_
