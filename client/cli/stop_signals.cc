#include "client/cli/stop_signals.h"

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cstdint>

#include "client/cli/command.h"

namespace duet::client::cli {

StopSignals::StopSignals(std::function<void()> on_first, std::chrono::nanoseconds one_stop)
    : one_stop_(one_stop) {
  sigemptyset(&stop_set_);
  sigaddset(&stop_set_, SIGINT);
  sigaddset(&stop_set_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &stop_set_, &before_);
  signals_ = signalfd(-1, &stop_set_, SFD_CLOEXEC);
  end_ = eventfd(0, EFD_CLOEXEC);
  watcher_ = std::thread([this, on_first = std::move(on_first)] { Watch(on_first); });
}

StopSignals::~StopSignals() {
  const uint64_t one = 1;
  (void)!write(end_, &one, sizeof(one));
  watcher_.join();
  // A late signal of the same stop must not end the process in the middle of its report.
  const timespec now{};
  while (stopping_ && sigtimedwait(&stop_set_, nullptr, &now) > 0) {
  }
  close(signals_);
  close(end_);
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void StopSignals::Watch(const std::function<void()>& on_first) {
  std::chrono::steady_clock::time_point first;
  for (;;) {
    pollfd files[] = {{signals_, POLLIN, 0}, {end_, POLLIN, 0}};
    if (poll(files, 2, -1) < 0) continue;
    if ((files[1].revents & POLLIN) != 0) return;
    signalfd_siginfo info;
    if (read(signals_, &info, sizeof(info)) != static_cast<ssize_t>(sizeof(info))) continue;
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
