#include "model/cleanup/low_pass.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace duet::cleanup {
namespace {

// The lag of a tap, and its weight.
struct Tap {
  int lag = 0;  // frames
  float weight = 0;
};

// In the order of their lags, as far as they reach within `frames` frames.
std::vector<Tap> Taps(double sigma_frames, int frames) {
  const int reach = std::min(frames - 1, static_cast<int>(std::ceil(3 * sigma_frames)));
  std::vector<Tap> taps(static_cast<std::size_t>(2 * reach + 1));
  for (int lag = 0; lag <= reach; ++lag) {
    const float weight =
        static_cast<float>(std::exp(-0.5 * lag * lag / (sigma_frames * sigma_frames)));
    taps[static_cast<std::size_t>(reach - lag)] = {-lag, weight};
    taps[static_cast<std::size_t>(reach + lag)] = {lag, weight};
  }
  return taps;
}

// Adds each tap to all frames at once, which the compiler does several numbers at a time; a frame's
// sum has the same order as if it were formed alone.
// Shapes: track and smooth [frames, width], smooth all 0.
void Smooth(int frames, int width, double sigma_frames, const float* track, float* smooth) {
  std::vector<float> weights(static_cast<std::size_t>(frames));
  for (const Tap& tap : Taps(sigma_frames, frames)) {
    const int first = std::max(0, -tap.lag), count = frames - std::abs(tap.lag);
    float* const to = smooth + first * width;
    const float* const from = track + (first + tap.lag) * width;
    for (int i = 0; i < count * width; ++i) to[i] += from[i] * tap.weight;
    float* const weight = weights.data() + first;
    for (int t = 0; t < count; ++t) weight[t] += tap.weight;
  }
  for (const float weight : weights) {
    for (int i = 0; i < width; ++i) *smooth++ /= weight;
  }
}

}  // namespace

std::vector<float> LowPass(const std::vector<float>& track, double sigma_frames) {
  std::vector<float> smooth(track.size());
  if (track.empty()) return smooth;
  Smooth(static_cast<int>(track.size()), 1, sigma_frames, track.data(), smooth.data());
  return smooth;
}

std::vector<motion::Vec3> LowPass(const std::vector<motion::Vec3>& track, double sigma_frames) {
  std::vector<motion::Vec3> smooth(track.size());
  if (track.empty()) return smooth;
  Smooth(static_cast<int>(track.size()), 3, sigma_frames, &track.front().x, &smooth.front().x);
  return smooth;
}

std::vector<float> MostAround(const std::vector<float>& track, int reach) {
  const int frames = static_cast<int>(track.size());
  std::vector<float> most;
  most.reserve(track.size());
  for (int t = 0; t < frames; ++t) {
    const auto first = track.begin() + std::max(0, t - reach);
    most.push_back(*std::max_element(first, track.begin() + std::min(frames, t + reach + 1)));
  }
  return most;
}

}  // namespace duet::cleanup
