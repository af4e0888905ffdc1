#ifndef DUET_CLIENT_CLI_STOP_SIGNALS_H_
#define DUET_CLIENT_CLI_STOP_SIGNALS_H_

#include <csignal>
#include <functional>
#include <thread>

namespace duet::client::cli {

// Handles SIGINT and SIGTERM during its lifetime: the first signal calls `on_first` in another
// thread, the second one ends the process immediately with kExitRetry.
//
// Threads that are started while it lives do not see the two signals: make it before others.
class StopSignals {
 public:
  explicit StopSignals(std::function<void()> on_first);
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals();

 private:
  void Watch(const std::function<void()>& on_first) const;

  sigset_t before_{};
  int signals_ = -1;
  int end_ = -1;
  std::thread watcher_;
};

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_STOP_SIGNALS_H_
