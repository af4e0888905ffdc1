#include "model/body/motion_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/motion/feet.h"

namespace duet::body {
namespace {

constexpr float kContactHeightMetres = 0.05f;
constexpr double kSkatingSpeedMetresPerSecond = 0.5;
constexpr double kCentimetresPerMetre = 100;

// (standard deviation) / mean of one bone's length.
double Drift(const motion::Poses& poses, const motion::Bone& bone) {
  double sum = 0, squares = 0;
  const double frames = poses.frame_count();
  for (int t = 0; t < poses.frame_count(); ++t) {
    const double length = Distance(poses.at(t, bone.parent), poses.at(t, bone.child));
    sum += length;
    squares += length * length;
  }
  const double mean = sum / frames;
  if (mean == 0) return 0;
  // Rounding may leave a tiny negative variance.
  return std::sqrt(std::max(0.0, squares / frames - mean * mean)) / mean;
}

}  // namespace

double BoneLengthDrift(const motion::Poses& poses, const motion::Skeleton& skeleton) {
  if (skeleton.bones.empty()) return 0;
  double sum = 0;
  for (const motion::Bone& bone : skeleton.bones) sum += Drift(poses, bone);
  return sum / static_cast<double>(skeleton.bones.size());
}

double Jitter(const motion::Poses& poses, double frame_rate_hz) {
  const int frames = poses.frame_count(), joints = poses.joint_count();
  if (frames < 4) return 0;
  double sum = 0;
  for (int t = 3; t < frames; ++t) {
    for (int j = 0; j < joints; ++j) {
      const motion::Vec3 third = poses.at(t, j) - 3.0f * poses.at(t - 1, j) +
                                 3.0f * poses.at(t - 2, j) - poses.at(t - 3, j);
      sum += Norm(third);
    }
  }
  return sum / ((frames - 3) * joints) * std::pow(frame_rate_hz, 3);
}

FootSlide MeasureFootSlide(const motion::Poses& poses, const motion::Skeleton& skeleton,
                           double frame_rate_hz) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!skeleton.feet) return {kNone, kNone};
  const float floor = LowestFoot(*skeleton.feet, poses);
  double steps = 0, skating = 0, moved = 0;
  for (int t = 1; t < poses.frame_count(); ++t) {
    for (const int foot : {skeleton.feet->left, skeleton.feet->right}) {
      const motion::Vec3 before = poses.at(t - 1, foot), now = poses.at(t, foot);
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

}  // namespace duet::body
