#ifndef DUET_SERVER_WATCHDOG_STOP_DEADLINE_H_
#define DUET_SERVER_WATCHDOG_STOP_DEADLINE_H_

namespace duet::server::watchdog {

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

#endif  // DUET_SERVER_WATCHDOG_STOP_DEADLINE_H_
