#include "client/cli/stop_signals.h"

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cstdint>

#include "client/cli/exit_code.h"

namespace duet::client::cli {

StopSignals::StopSignals(std::function<void()> on_first) {
  sigset_t stopping;
  sigemptyset(&stopping);
  sigaddset(&stopping, SIGINT);
  sigaddset(&stopping, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &stopping, &before_);
  signals_ = signalfd(-1, &stopping, SFD_CLOEXEC);
  end_ = eventfd(0, EFD_CLOEXEC);
  watcher_ = std::thread([this, on_first = std::move(on_first)] { Watch(on_first); });
}

StopSignals::~StopSignals() {
  const uint64_t one = 1;
  (void)!write(end_, &one, sizeof(one));
  watcher_.join();
  close(signals_);
  close(end_);
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void StopSignals::Watch(const std::function<void()>& on_first) const {
  for (int seen = 0;;) {
    pollfd files[] = {{signals_, POLLIN, 0}, {end_, POLLIN, 0}};
    if (poll(files, 2, -1) < 0) continue;
    if ((files[1].revents & POLLIN) != 0) return;
    signalfd_siginfo info;
    if (read(signals_, &info, sizeof(info)) != static_cast<ssize_t>(sizeof(info))) continue;
    if (++seen > 1) _exit(kExitRetry);
    on_first();
  }
}

}  // namespace duet::client::cli
