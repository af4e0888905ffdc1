#ifndef DUET_SERVER_SECURITY_CALLER_USAGE_H_
#define DUET_SERVER_SECURITY_CALLER_USAGE_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "server/common/clock.h"
#include "server/common/mutex.h"

namespace duet::server::security {

// The current usage of one caller.
//
// Threads: safe to call concurrently. Uses neither gRPC nor abseil.
class CallerUsage {
 public:
  // Counts a call and returns nullopt, or returns the seconds to wait if the rate is exceeded. The
  // long-term rate is `per_second`; after a pause, the calls of one second may arrive at once.
  std::optional<double> TakeCall(double per_second, common::TimePoint now);

  // Counts frames and returns true, unless the total would exceed `limit`.
  bool TakeFrames(std::int64_t frames, std::int64_t limit);
  void GiveFrames(std::int64_t frames);
  std::int64_t frames() const;

 private:
  mutable common::Mutex mutex_;
  double tokens_ DUET_GUARDED_BY(mutex_) = 0;  // calls allowed now
  std::optional<common::TimePoint> counted_
      DUET_GUARDED_BY(mutex_);  // when tokens_ was last updated
  std::int64_t frames_ DUET_GUARDED_BY(mutex_) = 0;
};

// Frames that a call holds. The destructor returns them.
class FrameLease {
 public:
  FrameLease() = default;
  FrameLease(std::shared_ptr<CallerUsage> usage, std::int64_t frames)
      : usage_(std::move(usage)), frames_(frames) {}
  FrameLease(FrameLease&&) = default;
  FrameLease& operator=(FrameLease&& other) noexcept {
    std::swap(usage_, other.usage_);
    std::swap(frames_, other.frames_);
    return *this;
  }
  ~FrameLease() {
    if (usage_ != nullptr) usage_->GiveFrames(frames_);
  }

 private:
  std::shared_ptr<CallerUsage> usage_;
  std::int64_t frames_ = 0;
};

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_CALLER_USAGE_H_
