#include "server/common/periodic.h"

#include <utility>

namespace duet::server::common {

Periodic::Periodic(std::chrono::milliseconds interval, std::function<void()> work)
    : interval_(interval), work_(std::move(work)), thread_([this] { Run(); }) {}

Periodic::~Periodic() {
  {
    MutexLock lock(mutex_);
    stop_ = true;
  }
  stopped_.NotifyAll();
  thread_.join();
}

void Periodic::Run() {
  while (true) {
    const auto end = std::chrono::steady_clock::now() + interval_;
    {
      MutexLock lock(mutex_);
      while (!stop_ && stopped_.WaitUntil(mutex_, end)) {
      }
      if (stop_) return;
    }
    work_();
  }
}

}  // namespace duet::server::common
