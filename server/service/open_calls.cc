#include "server/service/open_calls.h"

#include <chrono>

namespace duet::server::service {

void OpenCalls::Add(int calls) {
  common::MutexLock lock(mutex_);
  open_ += calls;
  if (open_ == 0) changed_.NotifyAll();
}

void OpenCalls::WaitForNone(double seconds) {
  const auto end = std::chrono::steady_clock::now() +
                   std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                       std::chrono::duration<double>(seconds));
  common::MutexLock lock(mutex_);
  while (open_ > 0 && changed_.WaitUntil(mutex_, end)) {
  }
}

}  // namespace duet::server::service
