#include "server/watchdog/stop_signal.h"

#include <pthread.h>
#include <signal.h>

#include <chrono>
#include <initializer_list>

namespace duet::server::watchdog {
namespace {

void SetMask(int how) {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals, signal);
  pthread_sigmask(how, &signals, nullptr);
}

}  // namespace

StopSignal::StopSignal() { SetMask(SIG_BLOCK); }

// NOLINTNEXTLINE(readability-convert-member-functions-to-static)
void StopSignal::Unblock() { SetMask(SIG_UNBLOCK); }

void StopSignal::Note(Kind kind) {
  common::MutexLock lock(mutex_);
  if (kind == Kind::kStop) {
    ++stops_;
  } else {
    reload_ = true;
  }
  changed_.NotifyAll();
}

StopSignal::Kind StopSignal::Wait() {
  common::MutexLock lock(mutex_);
  while (true) {
    if (TakeStop()) return Kind::kStop;
    if (reload_) {
      reload_ = false;
      return Kind::kReload;
    }
    changed_.Wait(mutex_);
  }
}

bool StopSignal::WaitFor(double seconds) {
  const auto end = std::chrono::steady_clock::now() +
                   std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                       std::chrono::duration<double>(seconds));
  common::MutexLock lock(mutex_);
  while (true) {
    if (TakeStop()) return true;
    if (!changed_.WaitUntil(mutex_, end)) return TakeStop();
  }
}

bool StopSignal::TakeStop() {
  if (stops_ == 0) return false;
  --stops_;
  return true;
}

}  // namespace duet::server::watchdog
