#include "model/evaluation/metrics/motion_quality.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace duet::evaluation::metrics {
namespace {

constexpr float kContactHeightMetres = 0.05f;
constexpr double kSkatingSpeedMetresPerSecond = 0.5;
constexpr double kCentimetresPerMetre = 100;

// (standard deviation) / mean of one bone's length.
double Drift(const std::vector<motion::Vec3>& positions, size_t joints, const motion::Bone& bone) {
  double sum = 0, squares = 0, frames = 0;
  for (size_t first = 0; first < positions.size(); first += joints) {
    const double length = Distance(positions[first + static_cast<size_t>(bone.parent)],
                                   positions[first + static_cast<size_t>(bone.child)]);
    sum += length;
    squares += length * length;
    ++frames;
  }
  const double mean = sum / frames;
  if (mean == 0) return 0;
  // Rounding may leave a tiny negative variance.
  return std::sqrt(std::max(0.0, squares / frames - mean * mean)) / mean;
}

}  // namespace

double BoneLengthDrift(const std::vector<motion::Vec3>& positions,
                       const motion::Skeleton& skeleton) {
  if (skeleton.bones.empty()) return 0;
  double sum = 0;
  for (const motion::Bone& bone : skeleton.bones) {
    sum += Drift(positions, static_cast<size_t>(skeleton.joint_count()), bone);
  }
  return sum / static_cast<double>(skeleton.bones.size());
}

double Jitter(const std::vector<motion::Vec3>& positions, int joints, double frame_rate_hz) {
  const size_t stride = static_cast<size_t>(joints);
  if (positions.size() < 4 * stride) return 0;
  double sum = 0;
  for (size_t i = 3 * stride; i < positions.size(); ++i) {
    const motion::Vec3 third = positions[i] - 3.0f * positions[i - stride] +
                               3.0f * positions[i - 2 * stride] - positions[i - 3 * stride];
    sum += Norm(third);
  }
  return sum / static_cast<double>(positions.size() - 3 * stride) * std::pow(frame_rate_hz, 3);
}

FootSlide MeasureFootSlide(const std::vector<motion::Vec3>& positions,
                           const motion::Skeleton& skeleton, double frame_rate_hz) {
  const size_t stride = static_cast<size_t>(skeleton.joint_count());
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!skeleton.feet) return {kNone, kNone};
  const size_t feet[] = {static_cast<size_t>(skeleton.feet->left),
                         static_cast<size_t>(skeleton.feet->right)};
  float floor = std::numeric_limits<float>::max();
  for (size_t first = 0; first < positions.size(); first += stride) {
    for (size_t foot : feet) floor = std::min(floor, positions[first + foot].y);
  }
  double steps = 0, skating = 0, moved = 0;
  for (size_t first = stride; first < positions.size(); first += stride) {
    for (size_t foot : feet) {
      const motion::Vec3 before = positions[first - stride + foot], now = positions[first + foot];
      if (std::max(before.y, now.y) > floor + kContactHeightMetres) continue;
      const double step = std::hypot(now.x - before.x, now.z - before.z);
      ++steps;
      moved += step;
      if (step * frame_rate_hz > kSkatingSpeedMetresPerSecond) ++skating;
    }
  }
  if (steps == 0) return {};
  return {skating / steps, moved / steps * kCentimetresPerMetre};
}

}  // namespace duet::evaluation::metrics
