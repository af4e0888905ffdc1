#ifndef DUET_MODEL_CLEANUP_LOW_PASS_H_
#define DUET_MODEL_CLEANUP_LOW_PASS_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace duet::cleanup {

// Smooths a track (numbers or Vec3) over time with a Gaussian, truncated at three standard
// deviations and renormalised at the ends. Returns as many frames as `track` has.
template <typename Value>
std::vector<Value> LowPass(const std::vector<Value>& track, double sigma_frames) {
  const int frames = static_cast<int>(track.size());
  const int reach = static_cast<int>(std::ceil(3 * sigma_frames));
  std::vector<float> kernel;
  for (int k = 0; k <= reach; ++k) {
    kernel.push_back(static_cast<float>(std::exp(-0.5 * k * k / (sigma_frames * sigma_frames))));
  }
  std::vector<Value> smooth;
  smooth.reserve(track.size());
  for (int t = 0; t < frames; ++t) {
    Value sum{};
    float weights = 0;
    for (int u = std::max(0, t - reach); u <= std::min(frames - 1, t + reach); ++u) {
      const float weight = kernel[static_cast<std::size_t>(std::abs(u - t))];
      sum += track[static_cast<std::size_t>(u)] * weight;
      weights += weight;
    }
    smooth.push_back(sum / weights);
  }
  return smooth;
}

// Returns the maximum within `reach` frames on either side.
inline std::vector<float> MostAround(const std::vector<float>& track, int reach) {
  const int frames = static_cast<int>(track.size());
  std::vector<float> most;
  for (int t = 0; t < frames; ++t) {
    const auto first = track.begin() + std::max(0, t - reach);
    most.push_back(*std::max_element(first, track.begin() + std::min(frames, t + reach + 1)));
  }
  return most;
}

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_LOW_PASS_H_
