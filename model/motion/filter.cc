#include "model/motion/filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace duet::motion {
namespace {

constexpr double kKernelSigmas = 3;

constexpr int kJumpReach = 2;            // frames on each side that a joint is compared with
constexpr float kJumpSpreads = 6;        // times the spread within the window
constexpr float kJumpLeastMetres = 0.1;  // smallest jump, even if the rest does not move

// Weights of the frames from -radius to radius; they add up to 1.
std::vector<double> GaussianKernel(double sigma, int radius) {
  std::vector<double> kernel;
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    kernel.push_back(std::exp(-0.5 * (i / sigma) * (i / sigma)));
    sum += kernel.back();
  }
  for (double& weight : kernel) weight /= sum;
  return kernel;
}

// A frame of the motion continued beyond its ends by reflection about its end points, repeatedly if
// the clip is short. Requires two frames.
Vec3 Reflected(const Poses& poses, int frame, int joint) {
  const int last = poses.frame_count() - 1;
  if (frame < 0) return 2 * poses.at(0, joint) - Reflected(poses, -frame, joint);
  if (frame > last) return 2 * poses.at(last, joint) - Reflected(poses, 2 * last - frame, joint);
  return poses.at(frame, joint);
}

float Median(std::vector<float> values) {
  const std::size_t half = values.size() / 2;
  std::sort(values.begin(), values.end());
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

// By coordinate.
Vec3 Median(const std::vector<Vec3>& points) {
  std::vector<float> x, y, z;
  for (const Vec3& point : points) {
    x.push_back(point.x);
    y.push_back(point.y);
    z.push_back(point.z);
  }
  return {Median(std::move(x)), Median(std::move(y)), Median(std::move(z))};
}

bool IsJump(const Vec3& point, const std::vector<Vec3>& around) {
  const Vec3 middle = Median(around);
  std::vector<float> distances;
  distances.reserve(around.size());
  for (const Vec3& other : around) distances.push_back(Distance(other, middle));
  const float spread = Median(std::move(distances));
  return Distance(point, middle) > std::max(kJumpLeastMetres, kJumpSpreads * spread);
}

}  // namespace

Poses GaussianFilter(const Poses& poses, double sigma_frames) {
  if (!(sigma_frames > 0) || poses.frame_count() < 2) return poses;
  const int radius = static_cast<int>(std::ceil(kKernelSigmas * sigma_frames));
  const std::vector<double> kernel = GaussianKernel(sigma_frames, radius);
  Poses smooth(poses.frame_count(), poses.joint_count());
  for (int t = 0; t < poses.frame_count(); ++t) {
    for (int j = 0; j < poses.joint_count(); ++j) {
      double x = 0, y = 0, z = 0;
      for (int i = -radius; i <= radius; ++i) {
        const double weight = kernel[static_cast<std::size_t>(i + radius)];
        const Vec3 point = Reflected(poses, t + i, j);
        x += weight * point.x;
        y += weight * point.y;
        z += weight * point.z;
      }
      smooth.at(t, j) = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    }
  }
  return smooth;
}

Poses WithoutNoise(const Poses& poses, double frame_rate_hz) {
  return GaussianFilter(poses, kNoiseFilterSeconds * frame_rate_hz);
}

int RepairJumps(Poses* poses) {
  const Poses before = *poses;
  const int frames = before.frame_count();
  if (frames < 3) return 0;
  int repaired = 0;
  std::vector<Vec3> around, others;
  for (int t = 0; t < frames; ++t) {
    for (int j = 0; j < before.joint_count(); ++j) {
      around.clear();
      others.clear();
      for (int i = std::max(0, t - kJumpReach); i <= std::min(frames - 1, t + kJumpReach); ++i) {
        around.push_back(before.at(i, j));
        if (i != t) others.push_back(before.at(i, j));
      }
      if (!IsJump(before.at(t, j), around)) continue;
      poses->at(t, j) = Median(others);
      ++repaired;
    }
  }
  return repaired;
}

}  // namespace duet::motion
