#include "model/network/flow_noise.h"

#include <algorithm>

#include "model/base/random.h"

namespace duet::network {
namespace {

// Added to the kernel's diagonal, so that rounding does not make it indefinite.
constexpr double kRidge = 1e-4;

void Fill(int64_t count, base::Random* random, float* out) {
  for (int64_t i = 0; i < count; ++i) out[i] = static_cast<float>(random->StandardNormal());
}

// [T, T] lower-triangular: the root of constant + (1 - constant) exp(-(distance / length)^2 / 2).
torch::Tensor FrameRoot(int64_t frames, double length, double constant) {
  const torch::Tensor frame = torch::arange(frames, torch::kFloat64);
  const torch::Tensor distance = (frame.unsqueeze(0) - frame.unsqueeze(1)) / length;
  const torch::Tensor kernel = constant + (1 - constant) * torch::exp(-0.5 * distance * distance) +
                               kRidge * torch::eye(frames, torch::kFloat64);
  return torch::linalg_cholesky(kernel).to(torch::kFloat32);
}

// [N, T, 1] fraction of the full deviation: it grows from the last known frame.
torch::Tensor Ramp(const torch::Tensor& known_count, int64_t frames, int ramp_frames) {
  const torch::Tensor frame = torch::arange(frames).unsqueeze(0);
  const torch::Tensor since = frame - known_count.unsqueeze(1) + 2;
  return (since.to(torch::kFloat32) / ramp_frames).clamp(1.0 / ramp_frames, 1).unsqueeze(2);
}

}  // namespace

NoiseNumbers DrawNoise(absl::Span<const engine::NetworkInput> inputs) {
  int64_t frames = 0;
  for (const engine::NetworkInput& input : inputs) {
    frames = std::max<int64_t>(frames, input.leader.frame_count());
  }
  const int64_t width = 3 * int64_t{inputs.front().leader.joint_count()};
  const std::vector<int64_t> shape = {static_cast<int64_t>(inputs.size()), frames, width};
  NoiseNumbers numbers{torch::zeros(shape), torch::zeros(shape)};
  for (std::size_t n = 0; n < inputs.size(); ++n) {
    base::Random random(inputs[n].sampling.seed, 0);
    const int64_t first = static_cast<int64_t>(n) * frames * width;
    const int64_t count = inputs[n].leader.frame_count() * width;
    Fill(count, &random, numbers.smooth.data_ptr<float>() + first);
    Fill(count, &random, numbers.white.data_ptr<float>() + first);
  }
  return numbers;
}

torch::Tensor SourceNoise(const checkpoint::FlowArchitecture::Noise& options,
                          const torch::Tensor& roots, const torch::Tensor& known_count,
                          const NoiseNumbers& numbers) {
  const int64_t frames = numbers.smooth.size(1);
  const auto smooth = [&](double constant, int64_t state) {
    const torch::Tensor root = FrameRoot(frames, options.frame_length, constant);
    return torch::matmul(torch::matmul(root, numbers.smooth), roots[state]);
  };
  const torch::Tensor told = (known_count > 0).view({-1, 1, 1});
  const torch::Tensor ramp = Ramp(known_count, frames, options.ramp_frames);
  return torch::where(told, ramp * smooth(0, 1), smooth(options.constant_share, 0)) +
         options.white * numbers.white;
}

}  // namespace duet::network
