#include "client/capture/rate_estimate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace duet::client::capture {
namespace {

constexpr double kMeasuredSeconds = 1;
constexpr double kUsualRates[] = {10, 12, 15, 20, 24, 25, 30, 50, 60, 72, 75, 90, 100, 120};
constexpr double kNear = 0.04;  // of a usual rate
// Intervals beyond this part of the median are lost frames or bursts.
constexpr double kOutlier = 0.5;

// The usual rate nearest to a measured one, or the measured one if none is near.
double Usual(double rate) {
  double nearest = rate, least = kNear;
  for (const double usual : kUsualRates) {
    const double difference = std::abs(rate - usual) / usual;
    if (difference > least) continue;
    nearest = usual;
    least = difference;
  }
  return nearest;
}

}  // namespace

void RateEstimate::Add(double seconds) {
  // A clock that jumps begins anew.
  if (!times_.empty() && std::abs(seconds - times_.back()) > kMeasuredSeconds) times_.clear();
  if (times_.size() < kMaxFrames) times_.push_back(seconds);
}

std::optional<double> RateEstimate::rate_hz() const {
  std::vector<double> sorted = times_;
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> intervals;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i] > sorted[i - 1]) intervals.push_back(sorted[i] - sorted[i - 1]);
  }
  if (intervals.size() < kMinFrames) return std::nullopt;
  if (sorted.back() - sorted.front() < kMeasuredSeconds && sorted.size() < kMaxFrames) {
    return std::nullopt;
  }
  std::nth_element(intervals.begin(),
                   intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2),
                   intervals.end());
  const double median = intervals[intervals.size() / 2];
  double sum = 0;
  int count = 0;
  for (const double interval : intervals) {
    if (std::abs(interval - median) > kOutlier * median) continue;
    sum += interval;
    ++count;
  }
  double rate = count / sum;
  rate /= std::ceil(rate / kMaxRateHz - kNear);
  return std::max(Usual(rate), 1.0);
}

}  // namespace duet::client::capture
