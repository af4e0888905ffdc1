#include "client/cli/stop_signals.h"

#include <pthread.h>
#include <unistd.h>

#include "client/cli/command.h"

namespace duet::client::cli {

StopSignals::StopSignals(std::function<void()> on_first, std::chrono::nanoseconds one_stop)
    : one_stop_(one_stop) {
  sigemptyset(&stop_set_);
  sigaddset(&stop_set_, SIGINT);
  sigaddset(&stop_set_, SIGTERM);
  sigaddset(&stop_set_, SIGRTMIN);  // ends Watch
  pthread_sigmask(SIG_BLOCK, &stop_set_, &before_);
  watcher_ = std::thread([this, on_first = std::move(on_first)] { Watch(on_first); });
}

StopSignals::~StopSignals() {
  pthread_kill(watcher_.native_handle(), SIGRTMIN);
  watcher_.join();
  // A late signal of the same stop must not end the process in the middle of its report.
  const timespec now{};
  while (stopping_ && sigtimedwait(&stop_set_, nullptr, &now) > 0) {
  }
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void StopSignals::Watch(const std::function<void()>& on_first) {
  std::chrono::steady_clock::time_point first;
  for (;;) {
    int signal = 0;
    if (sigwait(&stop_set_, &signal) != 0) continue;
    if (signal == SIGRTMIN) return;
    const auto now = std::chrono::steady_clock::now();
    if (!stopping_) {
      stopping_ = true;
      first = now;
      on_first();
    } else if (now - first > one_stop_) {
      _exit(kExitRetry);
    }
  }
}

}  // namespace duet::client::cli
