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

// The motion continued by `radius` frames beyond each end, by reflection about its end points,
// repeatedly if the clip is short: [frames + 2 radius, 3 joints]. Requires two frames.
std::vector<double> Continued(const Poses& poses, int radius) {
  const int frames = poses.frame_count(), last = frames - 1;
  const std::ptrdiff_t width = 3 * std::ptrdiff_t{poses.joint_count()};
  std::vector<double> rows(static_cast<std::size_t>((frames + 2 * radius) * width));
  double* const first = rows.data() + radius * width;
  const float* const values = &poses.all().front().x;
  std::copy_n(values, frames * width, first);
  const auto reflect = [&](int frame, int end, int other) {
    for (std::ptrdiff_t i = 0; i < width; ++i) {
      const float at_end = 2 * values[end * width + i];
      first[frame * width + i] = at_end - static_cast<float>(first[other * width + i]);
    }
  };
  // From the ends outwards: each frame reflects one that is there already.
  for (int beyond = 1; beyond <= radius; ++beyond) {
    reflect(-beyond, 0, beyond);
    reflect(last + beyond, last, last - beyond);
  }
  return rows;
}

}  // namespace

Poses GaussianFilter(const Poses& poses, double sigma_frames) {
  if (!(sigma_frames > 0) || poses.frame_count() < 2) return poses;
  const int radius = static_cast<int>(std::ceil(kKernelSigmas * sigma_frames));
  const std::vector<double> kernel = GaussianKernel(sigma_frames, radius);
  const std::vector<double> rows = Continued(poses, radius);
  const std::size_t width = 3 * static_cast<std::size_t>(poses.joint_count());
  // Coordinate by coordinate of a whole clip, so that compilers vectorise the sums.
  std::vector<double> sums(3 * poses.all().size(), 0.0);
  for (std::size_t i = 0; i < kernel.size(); ++i) {
    const double weight = kernel[i];
    const double* const from = rows.data() + i * width;
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += weight * from[k];
  }
  Poses smooth(poses.frame_count(), poses.joint_count());
  float* out = &smooth.all().front().x;
  for (const double sum : sums) *out++ = static_cast<float>(sum);
  return smooth;
}

Poses WithoutNoise(const Poses& poses, double frame_rate_hz) {
  return GaussianFilter(poses, kNoiseFilterSeconds * frame_rate_hz);
}

}  // namespace duet::motion
