#include "contrib/load/measurement.h"

namespace duet::contrib::load {
namespace {

constexpr Duration kLate = std::chrono::milliseconds(10);

double PerSecond(int64_t count, double seconds) {
  return seconds > 0 ? static_cast<double>(count) / seconds : 0;
}

}  // namespace

double Measurement::answered_per_second() const { return PerSecond(answered_in_time, seconds); }
double Measurement::frames_per_second() const { return PerSecond(frames_in_time, seconds); }
double Measurement::due_per_second() const { return PerSecond(due, seconds); }
double Measurement::sent_per_second() const { return PerSecond(sent, seconds); }

bool KeptUp(const Measurement& measurement) {
  return measurement.sent == measurement.due && measurement.late.Percentile(99) <= kLate.count();
}

LogHistogram NotAnswered(const Measurement& measurement) {
  LogHistogram all;
  for (const auto& [code, times] : measurement.ended) {
    if (code != absl::StatusCode::kOk) all.Add(times);
  }
  return all;
}

}  // namespace duet::contrib::load
