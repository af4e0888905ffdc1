#include "client/live/ends.h"

#include "absl/time/clock.h"

namespace duet::client::live {

absl::StatusOr<LeaderFormat> ClipSource::Open() {
  return LeaderFormat{clip_.joint_names, clip_.frame_rate_hz};
}

// Returns false if Stop was called.
bool ClipSource::WaitForFrame() {
  std::unique_lock<std::mutex> lock(mutex_);
  if (!realtime_) return !stopped_;
  // From the first call on, which follows the beginning of the session.
  if (next_ == 0) begin_ = std::chrono::steady_clock::now();
  const auto due =
      begin_ + std::chrono::nanoseconds(static_cast<int64_t>(next_ * 1e9 / clip_.frame_rate_hz));
  return !stopping_.wait_until(lock, due, [this] { return stopped_; });
}

absl::StatusOr<std::optional<LeaderEvent>> ClipSource::Next() {
  if (next_ >= clip_.frame_count() || !WaitForFrame()) return std::nullopt;
  const auto pose = clip_.poses[next_];
  return LeaderFrame{next_++, {pose.begin(), pose.end()}, absl::Now()};
}

void ClipSource::Stop() {
  const std::lock_guard<std::mutex> lock(mutex_);
  stopped_ = true;
  stopping_.notify_all();
}

}  // namespace duet::client::live
