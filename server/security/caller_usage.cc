#include "server/security/caller_usage.h"

#include <algorithm>

namespace duet::server::security {

std::optional<double> CallerUsage::TakeCall(double per_second, common::TimePoint now) {
  const double most = std::max(1.0, per_second);
  common::MutexLock lock(mutex_);
  // Threads read the clock before they get the lock, so `now` may be a little old.
  const double passed =
      counted_.has_value() ? std::max(0.0, common::SecondsBetween(*counted_, now)) : 0;
  tokens_ = counted_.has_value() ? std::min(most, tokens_ + passed * per_second) : most;
  counted_ = counted_.has_value() ? std::max(*counted_, now) : now;
  if (tokens_ < 1) return (1 - tokens_) / per_second;
  tokens_ -= 1;
  return std::nullopt;
}

bool CallerUsage::TakeFrames(std::int64_t frames, std::int64_t limit) {
  common::MutexLock lock(mutex_);
  if (frames > limit - frames_) return false;
  frames_ += frames;
  return true;
}

void CallerUsage::GiveFrames(std::int64_t frames) {
  common::MutexLock lock(mutex_);
  frames_ -= frames;
}

std::int64_t CallerUsage::frames() const {
  common::MutexLock lock(mutex_);
  return frames_;
}

}  // namespace duet::server::security
