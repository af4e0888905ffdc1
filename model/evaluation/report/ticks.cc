#include "model/evaluation/report/ticks.h"

#include <cmath>
#include <cstddef>
#include <cstdio>

namespace duet::evaluation::report {
namespace {

constexpr double kRounding = 1e-9;
constexpr size_t kFewPowers = 3;
constexpr size_t kFewTicks = 4;

// Those of a power of ten times each factor that lie within [low, high], in order.
std::vector<double> PowersTimes(const std::vector<double>& factors, double low, double high) {
  std::vector<double> ticks;
  for (double power = std::floor(std::log10(low)); power <= std::log10(high); ++power) {
    for (const double factor : factors) {
      const double tick = factor * std::pow(10, power);
      if (tick >= low * (1 - kRounding) && tick <= high * (1 + kRounding)) ticks.push_back(tick);
    }
  }
  return ticks;
}

}  // namespace

std::vector<double> RoundTicks(double low, double high, int count) {
  const double rough = (high - low) / count;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power < rough * (1 - kRounding)) continue;
    step = factor * power;
    break;
  }
  std::vector<double> ticks;
  // Counted, not added up: sums of steps would drift.
  const double first = std::ceil(low / step - kRounding);
  const double last = std::floor(high / step + kRounding);
  for (double i = first; i <= last; ++i) ticks.push_back(i * step);
  return ticks;
}

std::vector<double> LogTicks(double low, double high, int count) {
  std::vector<double> ticks = PowersTimes({1}, low, high);
  if (ticks.size() < kFewPowers) ticks = PowersTimes({1, 2, 5}, low, high);
  return ticks.size() < kFewTicks ? RoundTicks(low, high, count) : ticks;
}

std::string TickText(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", std::abs(value) < 1e-12 ? 0 : value);
  return text;
}

}  // namespace duet::evaluation::report
