#include "model/formats/flat/csv_times.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/match.h"
#include "model/base/text.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::flat {
namespace {

// A column with a lower rate does not hold seconds.
constexpr double kSlowestTimedRateHz = 1;
constexpr double kUsualRatesHz[] = {15, 24, 25, 30, 50, 60, 90, 100, 120, 240};
constexpr std::size_t kMostDecimals = 9;  // of times; further digits are floating-point noise

}  // namespace

void CsvTimes::Add(absl::string_view text) {
  double seconds = 0;
  readable_ = readable_ && base::ParseNumber(text, &seconds);
  if (!readable_) return;
  const std::size_t point = text.find('.');
  const std::size_t decimals = point == absl::string_view::npos ? 0 : text.size() - point - 1;
  decimals_ = std::max(decimals_, absl::StrContains(text, 'e') ? kMostDecimals : decimals);
  seconds_.push_back(seconds);
}

double CsvTimes::FrameRate() const {
  if (!readable_ || seconds_.size() < 2) return 0;
  const double steps = static_cast<double>(seconds_.size() - 1);
  const double rate = steps / (seconds_.back() - seconds_.front());
  if (!(rate >= kSlowestTimedRateHz && rate <= motion::kMaxFrameRateHz)) return 0;
  for (std::size_t i = 0; i < seconds_.size(); ++i) {
    const double step = (seconds_[i] - seconds_.front()) * rate;
    if (std::abs(step - static_cast<double>(i)) > 0.5) return 0;
  }
  return Meant(rate);
}

double CsvTimes::Meant(double rate) const {
  const double rounding = std::pow(10, -static_cast<double>(std::min(decimals_, kMostDecimals)));
  const double steps = static_cast<double>(seconds_.size() - 1);
  const auto fits = [&](double candidate) {
    return std::abs(steps / candidate - steps / rate) <= rounding;
  };
  double best = fits(std::round(rate)) ? std::round(rate) : rate;
  double nearest = motion::kMaxFrameRateHz;
  for (double usual : kUsualRatesHz) {
    if (!fits(usual) || std::abs(usual - rate) >= nearest) continue;
    best = usual;
    nearest = std::abs(usual - rate);
  }
  return best;
}

}  // namespace duet::formats::flat
