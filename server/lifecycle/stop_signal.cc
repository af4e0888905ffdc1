#include "server/lifecycle/stop_signal.h"

#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <ctime>

namespace duet::server::lifecycle {
namespace {

sigset_t StopSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  return signals;
}

sigset_t AllSignals() {
  sigset_t signals = StopSignals();
  sigaddset(&signals, SIGHUP);
  return signals;
}

}  // namespace

StopSignal::StopSignal() {
  const sigset_t signals = AllSignals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

StopSignal::Kind StopSignal::Wait() {
  if (WaitFor(0)) return Kind::kStop;
  const sigset_t signals = AllSignals();
  int signal = 0;
  while (sigwait(&signals, &signal) == EINTR) {
  }
  return signal == SIGHUP ? Kind::kReload : Kind::kStop;
}

bool StopSignal::WaitFor(double seconds) {
  const sigset_t signals = StopSignals();
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (true) {
    const auto left = end - std::chrono::steady_clock::now();
    const auto nanoseconds =
        std::max<int64_t>(0, std::chrono::duration_cast<std::chrono::nanoseconds>(left).count());
    timespec timeout = {};
    timeout.tv_sec = static_cast<time_t>(nanoseconds / 1'000'000'000);
    timeout.tv_nsec = static_cast<long>(nanoseconds % 1'000'000'000);
    if (sigtimedwait(&signals, nullptr, &timeout) > 0) return true;
    // Stopped and continued (EINTR): wait on.
    if (errno != EINTR) return false;
  }
}

}  // namespace duet::server::lifecycle
