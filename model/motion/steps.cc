#include "model/motion/steps.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "model/base/statistics.h"
#include "model/motion/filter.h"

namespace duet::motion {
namespace {

constexpr double kRestSpeed = 0.3;

// The signed time from `time` to the nearest of `times`; NaN if there is none.
double TimeToNearest(double time, const std::vector<double>& times) {
  if (times.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto after = std::lower_bound(times.begin(), times.end(), time);
  if (after == times.begin()) return *after - time;
  const double before = *std::prev(after);
  if (after == times.end() || time - before <= *after - time) return before - time;
  return *after - time;
}

}  // namespace

double SpeedAt(const Poses& poses, int frame, int joint, double frame_rate_hz) {
  if (frame == 0) return 0;
  return Distance(poses.at(frame, joint), poses.at(frame - 1, joint)) * frame_rate_hz;
}

std::vector<double> FindSteps(const JointPair& feet, const Poses& person, double frame_rate_hz) {
  const Poses calm = WithoutNoise(person, frame_rate_hz);
  std::vector<double> steps;
  for (const int foot : {feet.left, feet.right}) {
    for (int t = 2; t < calm.frame_count(); ++t) {
      const double before = SpeedAt(calm, t - 1, foot, frame_rate_hz);
      if (before >= kRestSpeed && SpeedAt(calm, t, foot, frame_rate_hz) < kRestSpeed) {
        steps.push_back(t / frame_rate_hz);
      }
    }
  }
  std::sort(steps.begin(), steps.end());
  return steps;
}

StepTiming MeasureStepTiming(const std::vector<double>& steps, const std::vector<double>& times,
                             double farthest) {
  std::vector<double> offsets, distances;
  int far = 0;
  for (const double step : steps) {
    const double offset = TimeToNearest(step, times);
    far += std::abs(offset) > farthest;
    if (std::abs(offset) > farthest) continue;
    offsets.push_back(offset);
    distances.push_back(std::abs(offset));
  }
  return {static_cast<int>(offsets.size()), base::Summarise(distances).mean,
          base::Summarise(offsets).deviation, far};
}

}  // namespace duet::motion
