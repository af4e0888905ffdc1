#include "server/metrics/call_log_filter.h"

#include <utility>

namespace duet::server::metrics {

bool CallLogFilter::LogRefusal(int code, double now) {
  common::MutexLock lock(mutex_);
  Second& second = seconds_.at(static_cast<std::size_t>(code));
  // A clock that was set back begins a new second as well.
  if (now < second.begin || now >= second.begin + 1) {
    second.begin = now;
    second.logged = 0;
  }
  const bool log = second.logged < refusals_per_second_;
  if (log) {
    ++second.logged;
  } else {
    ++second.unlogged;
  }
  return log;
}

std::vector<CallLogFilter::Unlogged> CallLogFilter::TakeUnlogged() {
  common::MutexLock lock(mutex_);
  std::vector<Unlogged> taken;
  for (std::size_t code = 0; code < kCodes; ++code) {
    const std::uint64_t calls = std::exchange(seconds_[code].unlogged, 0);
    if (calls > 0) taken.push_back({static_cast<int>(code), calls});
  }
  return taken;
}

}  // namespace duet::server::metrics
