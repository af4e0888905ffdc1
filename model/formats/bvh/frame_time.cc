#include "model/formats/bvh/frame_time.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "absl/strings/ascii.h"

namespace duet::formats::bvh {
namespace {

// Relative. A rate that is nearer to a whole number than the first is that number, unless it is a
// rounded common rate; nearer than the second, in any case.
constexpr double kRateTolerance = 5e-4, kExact = 1e-6;
// Of a frame time whose decimals cannot be counted (1e-2): it is not taken for a rounded one.
constexpr int kManyDecimals = 9;
// With fewer decimals, exporters round: .016 is a step of 16 ms, not 1/60.
constexpr int kFewestTruncated = 4;

const std::vector<double>& CommonRatesHz() {
  static const auto* const kRates =
      new std::vector<double>{12, 15, 20, 24, 25, 30, 48, 50, 60, 72, 90, 100, 120, 144, 240};
  return *kRates;
}

const std::vector<double>& BroadcastRatesHz() {
  static const auto* const kRates = new std::vector<double>{29.97, 59.94};
  return *kRates;
}

// The nearest of some rates whose frame time has the decimals of `seconds`; 0 if there is none.
double Nearest(const std::vector<double>& rates, double seconds, int decimals) {
  const double step = std::pow(10, -decimals);
  const double truncated = decimals >= kFewestTruncated ? step : step / 2;
  double nearest = 0;
  for (double rate : rates) {
    const double missing = 1 / rate - seconds;
    const bool fits = missing > -step / 2 && missing < truncated;
    if (fits && std::abs(rate - 1 / seconds) < std::abs(nearest - 1 / seconds)) nearest = rate;
  }
  return nearest;
}

}  // namespace

std::optional<int> DecimalsOf(absl::string_view number) {
  const std::size_t point = number.find('.');
  if (point == absl::string_view::npos) return std::nullopt;
  const absl::string_view decimals = number.substr(point + 1);
  const bool plain = std::all_of(decimals.begin(), decimals.end(),
                                 [](unsigned char c) { return absl::ascii_isdigit(c); });
  return plain ? std::optional<int>(static_cast<int>(decimals.size())) : std::nullopt;
}

double RateOfFrameTime(double seconds, std::optional<int> decimals) {
  const double rate = 1 / seconds, whole = std::round(rate);
  const auto is_whole = [&](double tolerance) {
    return whole >= 1 && std::abs(rate - whole) < tolerance * whole;
  };
  if (is_whole(kExact)) return whole;
  const int digits = decimals.value_or(kManyDecimals);
  if (const double common = Nearest(CommonRatesHz(), seconds, digits); common > 0) return common;
  if (is_whole(kRateTolerance)) return whole;
  const double broadcast = Nearest(BroadcastRatesHz(), seconds, digits);
  return broadcast > 0 ? broadcast : rate;
}

}  // namespace duet::formats::bvh
