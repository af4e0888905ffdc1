#include "model/motion/filter.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace duet::motion {
namespace {

constexpr double kKernelSigmas = 3;

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

}  // namespace duet::motion
