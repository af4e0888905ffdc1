#ifndef DUET_CONTRIB_LOAD_FIGURES_H_
#define DUET_CONTRIB_LOAD_FIGURES_H_

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace duet::contrib::load {

using Time = std::chrono::steady_clock::time_point;
using Duration = std::chrono::nanoseconds;

inline Duration Seconds(double seconds) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(seconds));
}
inline double ToSeconds(Duration duration) {
  return std::chrono::duration<double>(duration).count();
}

// A generator that sends more than one in a hundred over this time late has not kept up: the
// figures also measure it.
inline constexpr double kLateMs = 10;

// Durations of which percentiles are reported. It keeps all of them: 8 bytes each.
class Times {
 public:
  void Add(Duration time) { times_.push_back(time.count()); }

  int64_t count() const { return static_cast<int64_t>(times_.size()); }
  double MeanMs() const {
    if (times_.empty()) return 0;
    return std::accumulate(times_.begin(), times_.end(), 0.0) / 1e6 /
           static_cast<double>(times_.size());
  }

  // The smallest one that at least `percent` of all do not exceed (nearest rank), in milliseconds:
  // 0 gives the smallest, 100 the largest. 0 if there are none.
  double Ms(double percent) const {
    if (times_.empty()) return 0;
    const double exact = percent / 100 * static_cast<double>(times_.size());
    // Rounding must not turn rank 999 of 1,000 into 1,000.
    const auto rank = static_cast<std::ptrdiff_t>(std::max(1.0, std::ceil(exact - 1e-9)));
    std::vector<int64_t> times = times_;
    std::nth_element(times.begin(), times.begin() + rank - 1, times.end());
    return static_cast<double>(times[static_cast<std::size_t>(rank - 1)]) / 1e6;
  }

 private:
  std::vector<int64_t> times_;  // nanoseconds
};

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_FIGURES_H_
