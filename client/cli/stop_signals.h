#ifndef DUET_CLIENT_CLI_STOP_SIGNALS_H_
#define DUET_CLIENT_CLI_STOP_SIGNALS_H_

#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>
#include <mutex>
#include <thread>

namespace duet::client::cli {

// Signals that arrive this soon after the first one belong to it: a terminal and a wrapper such as
// `npx` or `timeout` each send one for the same Ctrl-C.
inline constexpr std::chrono::nanoseconds kOneStop = std::chrono::seconds(1);

// Handles SIGINT and SIGTERM during its lifetime: the first signal calls `on_first` in another
// thread, and one that arrives more than `one_stop` later ends the process immediately with
// kExitRetry.
//
// Threads that are started while it lives do not see the two signals: make it before others.
class StopSignals {
 public:
  explicit StopSignals(std::function<void()> on_first,
                       std::chrono::nanoseconds one_stop = kOneStop);
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals();

 private:
  void Watch(const std::function<void()>& on_first);

  const std::chrono::nanoseconds one_stop_;
  bool stopping_ = false;  // on_first was called; changed by the watcher only
  sigset_t stop_set_{};
  sigset_t before_{};
  std::thread watcher_;
};

// What a signal stops: a target, with Stop(), that may not exist yet when the signal arrives.
//
// Threads: safe to call concurrently.
template <typename Target>
class Stopper {
 public:
  // Null: there is none any more.
  void Set(Target* target) {
    const std::lock_guard<std::mutex> lock(mutex_);
    target_ = target;
    if (stopped_ && target_ != nullptr) target_->Stop();
  }
  void Stop() {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
    if (target_ != nullptr) target_->Stop();
  }
  bool stopped() const { return stopped_; }

 private:
  std::mutex mutex_;
  Target* target_ = nullptr;
  std::atomic<bool> stopped_{false};
};

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_STOP_SIGNALS_H_
