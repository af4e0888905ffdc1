#ifndef DUET_SERVER_LIFECYCLE_STOP_SIGNAL_H_
#define DUET_SERVER_LIFECYCLE_STOP_SIGNAL_H_

namespace duet::server::lifecycle {

// Waits for SIGTERM and SIGINT without signal handlers.
//
// Construct it before any other thread starts: threads inherit that the signals are blocked, and
// then only Wait sees them, even while models are being loaded.
// Threads: one thread waits.
class StopSignal {
 public:
  StopSignal();

  // Waits until a signal came.
  void Wait();
  // Waits for at most `seconds`. True when a signal came; 0 just looks.
  bool WaitFor(double seconds);
};

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_STOP_SIGNAL_H_
