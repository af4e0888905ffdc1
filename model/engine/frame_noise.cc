#include "model/engine/frame_noise.h"

#include <cmath>
#include <cstddef>

#include "model/base/split_mix.h"

namespace duet::engine {
namespace {

// Beyond this many lengths a weight is below a thousandth of the largest.
constexpr double kReachLengths = 2.5;

}  // namespace

void FrameUniforms(uint64_t seed, int64_t frame, absl::Span<double> out) {
  const uint64_t stream = base::SplitMix(seed, static_cast<uint64_t>(frame));
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = (static_cast<double>(base::SplitMix(stream, i + 1) >> 11) + 0.5) * 0x1.0p-53;
  }
}

std::vector<float> SmoothingWeights(double length) {
  const int reach = static_cast<int>(std::ceil(kReachLengths * length));
  std::vector<double> weights;
  double squares = 0;
  for (int d = -reach; d <= reach; ++d) {
    // Convolved with itself, a Gaussian becomes wider by the square root of two.
    weights.push_back(std::exp(-(d / length) * (d / length)));
    squares += weights.back() * weights.back();
  }
  std::vector<float> normalised;
  for (const double weight : weights) {
    normalised.push_back(static_cast<float>(weight / std::sqrt(squares)));
  }
  return normalised;
}

}  // namespace duet::engine
