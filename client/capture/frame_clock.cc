#include "client/capture/frame_clock.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/str_format.h"

namespace duet::client::capture {
namespace {

// Two times of one frame differ by rounding at most.
constexpr double kSameTime = 1e-5;
// After so many frames in succession that do not advance, the sender's clock has jumped back.
constexpr int kStaleFrames = 4;
// A gap is longer than this many periods of the sender.
constexpr double kGapPeriods = 1.5;
// The part of the output's period by which a sample's time may differ from the output's: of frames
// with times, and of frames with the times of their arrival, which are no better than the network.
constexpr double kSnapTimed = 0.2, kSnapArrived = 0.5;
// The part of that difference by which the output's phase follows.
constexpr double kPhaseGain = 0.1;
constexpr std::size_t kRecentTimes = 64;

}  // namespace

std::string Describe(const ClockEvent& event) {
  switch (event.kind) {
    case ClockEvent::Kind::kDuplicate:
      return absl::StrFormat("a duplicate before frame %d dropped", event.frame);
    case ClockEvent::Kind::kLate:
      return absl::StrFormat("a frame that is %.0f ms late dropped before frame %d",
                             event.seconds * 1e3, event.frame);
    case ClockEvent::Kind::kReordered:
      return absl::StrFormat("a frame put back into order before frame %d", event.frame);
    case ClockEvent::Kind::kBridged:
      return absl::StrFormat("a gap of %.2f s at frame %d interpolated", event.seconds,
                             event.frame);
    case ClockEvent::Kind::kHeld:
      return absl::StrFormat("nothing arrives for %.2f s: the pose is held from frame %d",
                             event.seconds, event.frame);
    case ClockEvent::Kind::kResumed:
      return absl::StrFormat("frames arrive again after %.2f s, at frame %d", event.seconds,
                             event.frame);
    case ClockEvent::Kind::kClockJumped:
      return absl::StrFormat("the sender's clock jumped by %.2f s at frame %d", event.seconds,
                             event.frame);
  }
  return "";
}

FrameClock::FrameClock(const FrameClockOptions& options)
    : options_(options), period_(1 / options.rate_hz) {}

void FrameClock::Receive(CaptureFrame frame, double now) {
  ++counts_.received;
  const bool is_first = counts_.received == 1;
  if (is_first && frame.sender_seconds.has_value()) shift_ = now - *frame.sender_seconds;
  has_times_ = frame.sender_seconds.has_value();
  double seconds = ToTimeline(frame, now);
  if (!is_first && has_times_ && seconds - newest_ < kSameTime) {
    const bool known = IsKnown(seconds);
    const bool usable = !known && seconds > std::max(left_.seconds, DueTime() - period_);
    if (++stale_ < kStaleFrames) {
      const double lateness = newest_ - seconds;
      if (known) {
        ++counts_.duplicates;
        Report(ClockEvent::Kind::kDuplicate);
      } else if (usable) {
        ++counts_.reordered;
        Report(ClockEvent::Kind::kReordered);
        Insert({seconds, now, std::move(frame.positions)});
      } else {
        ++counts_.late;
        Report(ClockEvent::Kind::kLate, lateness);
      }
      return;
    }
    ++counts_.jumps;
    Report(ClockEvent::Kind::kClockJumped, seconds - (now - Delay()));
    const double anew = std::max(now - Delay(), newest_ + kSameTime);
    shift_ += anew - seconds;
    seconds = anew;
  }
  stale_ = 0;
  if (!is_first && seconds - newest_ > kSameTime) {
    intervals_.push_back(seconds - newest_);
    if (intervals_.size() > kIntervals) intervals_.pop_front();
  }
  UpdateDelay(now - seconds, now);
  Insert({seconds, now, std::move(frame.positions)});
}

// Duplicates are recognised by the sender's times.
bool FrameClock::IsKnown(double seconds) const {
  return std::any_of(recent_.begin(), recent_.end(),
                     [seconds](double known) { return std::abs(known - seconds) < kSameTime; });
}

double FrameClock::ToTimeline(const CaptureFrame& frame, double now) {
  if (!frame.sender_seconds.has_value()) return std::max(now - Delay(), newest_);
  const double seconds = *frame.sender_seconds + shift_;
  if (counts_.received == 1) return seconds;
  // The smallest delay seen is exceeded by far: the sender's clock jumped forwards.
  const double lead = seconds + Delay() - now;
  if (lead <= options_.bridge_seconds) return seconds;
  ++counts_.jumps;
  Report(ClockEvent::Kind::kClockJumped, lead);
  shift_ -= lead;
  return seconds - lead;
}

void FrameClock::Insert(Sample sample) {
  newest_ = counts_.received == 1 ? sample.seconds : std::max(newest_, sample.seconds);
  recent_.push_back(sample.seconds);
  if (recent_.size() > kRecentTimes) recent_.pop_front();
  const auto later =
      std::upper_bound(waiting_.begin(), waiting_.end(), sample.seconds,
                       [](double seconds, const Sample& other) { return seconds < other.seconds; });
  waiting_.insert(later, std::move(sample));
  if (waiting_.size() > kMaxWaiting) waiting_.pop_front();
}

void FrameClock::UpdateDelay(double delay, double now) {
  const auto second = static_cast<int64_t>(std::floor(now));
  if (delays_.empty() || delays_.back().first != second) delays_.emplace_back(second, delay);
  delays_.back().second = std::min(delays_.back().second, delay);
  while (delays_.size() > kDelays) delays_.pop_front();
}

double FrameClock::Delay() const {
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& [second, delay] : delays_) smallest = std::min(smallest, delay);
  return delays_.empty() ? 0 : smallest;
}

// The median interval; infinite until there are some.
double FrameClock::SenderPeriod() const {
  if (intervals_.size() < 3) return std::numeric_limits<double>::infinity();
  std::vector<double> sorted(intervals_.begin(), intervals_.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

bool FrameClock::IsNext(double seconds) const {
  return std::abs(seconds - DueTime()) <= (has_times_ ? kSnapTimed : kSnapArrived) * period_;
}

std::optional<TimedFrame> FrameClock::Next(double now) {
  if (!started_) {
    if (waiting_.empty()) return std::nullopt;
    started_ = true;
    origin_ = waiting_.front().seconds;
    return EmitWaiting();
  }
  while (!waiting_.empty()) {
    const Sample& front = waiting_.front();
    if (IsNext(front.seconds)) {
      origin_ += kPhaseGain * (front.seconds - DueTime());
      return EmitWaiting();
    }
    if (front.seconds > DueTime()) return FillGap(now);
    // Held frames took its place; those after it are waited for again.
    EndHold();
    left_ = std::move(waiting_.front());
    waiting_.pop_front();
  }
  return HoldSilence(now);
}

// Ends a gap in which the pose was held.
void FrameClock::EndHold() {
  if (!std::exchange(in_hold_, false)) return;
  Report(ClockEvent::Kind::kResumed, held_until_ - held_from_);
}

TimedFrame FrameClock::EmitWaiting() {
  EndHold();
  in_bridge_ = false;
  left_ = std::move(waiting_.front());
  waiting_.pop_front();
  return Emit(TimedFrame::Source::kCaptured, left_.positions);
}

// The next frame lies between two samples.
std::optional<TimedFrame> FrameClock::FillGap(double now) {
  const Sample& right = waiting_.front();
  const double gap = right.seconds - left_.seconds;
  const bool frames_are_missing = gap > kGapPeriods * SenderPeriod();
  if (frames_are_missing && !in_hold_ && now < right.arrival + options_.reorder_seconds)
    return std::nullopt;
  if (gap > options_.bridge_seconds) {
    return Hold(gap);
  }
  EndHold();
  if (frames_are_missing) {
    if (!std::exchange(in_bridge_, true)) Report(ClockEvent::Kind::kBridged, gap);
    ++counts_.bridged_frames;
  } else {
    in_bridge_ = false;
  }
  const auto share = static_cast<float>((DueTime() - left_.seconds) / gap);
  std::vector<motion::Vec3> positions(left_.positions.size());
  for (std::size_t joint = 0; joint < positions.size(); ++joint) {
    positions[joint] = Lerp(left_.positions[joint], right.positions[joint], share);
  }
  return Emit(TimedFrame::Source::kInterpolated, std::move(positions));
}

// Nothing has arrived after the last sample.
std::optional<TimedFrame> FrameClock::HoldSilence(double now) {
  if (now < NextDue()) return std::nullopt;
  return Hold(now - Delay() - left_.seconds);
}

TimedFrame FrameClock::Hold(double gap) {
  if (!std::exchange(in_hold_, true)) {
    held_from_ = left_.seconds;
    Report(ClockEvent::Kind::kHeld, gap);
  }
  held_until_ = DueTime() + period_;
  ++counts_.held_frames;
  return Emit(TimedFrame::Source::kHeld, left_.positions);
}

double FrameClock::NextDue() const {
  if (!started_) return std::numeric_limits<double>::infinity();
  if (!waiting_.empty()) return waiting_.front().arrival + options_.reorder_seconds;
  const double silence = left_.seconds + options_.bridge_seconds + options_.reorder_seconds;
  return std::max(DueTime(), in_hold_ ? DueTime() : silence) + Delay();
}

TimedFrame FrameClock::Emit(TimedFrame::Source source, std::vector<motion::Vec3> positions) {
  TimedFrame frame{next_, DueTime() + Delay(), source, std::move(positions)};
  ++next_;
  return frame;
}

void FrameClock::Report(ClockEvent::Kind kind, double seconds) {
  if (events_.size() >= kMaxEvents) events_.erase(events_.begin());
  events_.push_back({kind, next_, seconds});
}

std::vector<ClockEvent> FrameClock::TakeEvents() { return std::exchange(events_, {}); }

}  // namespace duet::client::capture
