#include "model/network/flow_noise.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "model/base/angle.h"
#include "model/base/random.h"
#include "model/engine/frame_noise.h"

namespace duet::network {
namespace {

// Added to the kernel's diagonal, so that rounding does not make it indefinite.
constexpr double kRidge = 1e-4;

void Fill(int64_t count, base::Random* random, float* out) {
  for (int64_t i = 0; i < count; ++i) out[i] = static_cast<float>(random->StandardNormal());
}

// The normal numbers of frame `frame` of an endless motion: [2, W], those that become smooth first.
torch::Tensor FrameNormals(uint64_t seed, int64_t frame, int64_t width) {
  torch::Tensor uniform = torch::empty({2 * width, 2}, torch::kFloat64);
  engine::FrameUniforms(seed, frame,
                        {uniform.data_ptr<double>(), static_cast<std::size_t>(4 * width)});
  const torch::Tensor radius = torch::sqrt(-2 * torch::log(uniform.select(1, 0)));
  const torch::Tensor angle = 2 * base::kPi * uniform.select(1, 1);
  return (radius * torch::cos(angle)).to(torch::kFloat32).view({2, width});
}

// Draws the numbers of a window of an endless motion, the n-th of its batch.
void DrawEndless(const engine::NetworkInput& input, int64_t n, double frame_length,
                 NoiseNumbers* numbers) {
  const std::vector<float> weights = engine::SmoothingWeights(frame_length);
  const int64_t taps = static_cast<int64_t>(weights.size()), frames = input.leader.frame_count();
  const int64_t width = numbers->white.size(2), first = *input.sampling.first_frame - taps / 2;
  std::vector<torch::Tensor> rows;
  for (int64_t row = 0; row < frames + taps - 1; ++row) {
    rows.push_back(FrameNormals(input.sampling.seed, first + row, width));
  }
  const torch::Tensor drawn = torch::stack(rows);  // [rows, 2, W]
  for (int64_t k = 0; k < taps; ++k) {
    numbers->smooth[n].narrow(0, 0, frames) +=
        weights[static_cast<std::size_t>(k)] * drawn.select(1, 0).narrow(0, k, frames);
  }
  numbers->white[n].narrow(0, 0, frames).copy_(drawn.select(1, 1).narrow(0, taps / 2, frames));
  numbers->endless[n].fill_(true);
  numbers->constant[n][0].copy_(FrameNormals(input.sampling.seed, engine::kEveryFrame, width)[0]);
}

// The roots that were computed last, because every batch needs one again.
constexpr std::size_t kMostRoots = 256;

// [T, T] lower-triangular: the root of constant + (1 - constant) exp(-(distance / length)^2 / 2).
torch::Tensor ComputeFrameRoot(int64_t frames, double length, double constant) {
  const torch::Tensor frame = torch::arange(frames, torch::kFloat64);
  const torch::Tensor distance = (frame.unsqueeze(0) - frame.unsqueeze(1)) / length;
  const torch::Tensor kernel = constant + (1 - constant) * torch::exp(-0.5 * distance * distance) +
                               kRidge * torch::eye(frames, torch::kFloat64);
  return torch::linalg_cholesky(kernel).to(torch::kFloat32);
}

torch::Tensor FrameRoot(int64_t frames, double length, double constant,
                        const torch::Device& device) {
  thread_local std::map<std::tuple<int64_t, double, double, std::string>, torch::Tensor> roots;
  if (roots.size() >= kMostRoots) roots.clear();
  torch::Tensor& root = roots[{frames, length, constant, device.str()}];
  if (!root.defined()) root = ComputeFrameRoot(frames, length, constant).to(device);
  return root;
}

// [N, T, 1] fraction of the full deviation: it grows from the last known frame.
torch::Tensor Ramp(const torch::Tensor& known_count, int64_t frames, int ramp_frames) {
  const torch::Tensor frame = torch::arange(frames, known_count.options()).unsqueeze(0);
  const torch::Tensor since = frame - known_count.unsqueeze(1) + 2;
  return (since.to(torch::kFloat32) / ramp_frames).clamp(1.0 / ramp_frames, 1).unsqueeze(2);
}

// The noise of windows of an endless motion without what their last known frame determines
// (model/cpu_engine/flow_noise.h). Shapes: smooth [N, T, W], known_count [N].
torch::Tensor LeaveKnown(const torch::Tensor& smooth, const torch::Tensor& known_count,
                         double length) {
  const torch::Tensor last = (known_count - 1).clamp(0).view({-1, 1, 1});
  const torch::Tensor known = smooth.gather(1, last.expand({smooth.size(0), 1, smooth.size(2)}));
  const torch::Tensor distance =
      (torch::arange(smooth.size(1), last.options()).view({1, -1, 1}) - last).to(torch::kFloat32) /
      length;
  return smooth - torch::exp(-0.5 * distance * distance) * known;
}

}  // namespace

NoiseNumbers NoiseNumbers::To(const torch::Device& device) const {
  const auto moved = [&](const torch::Tensor& tensor) {
    return tensor.defined() ? tensor.to(device) : tensor;
  };
  return {moved(smooth), moved(white), moved(endless), moved(constant)};
}

NoiseNumbers DrawNoise(absl::Span<const engine::NetworkInput> inputs, double frame_length) {
  int64_t frames = 0;
  for (const engine::NetworkInput& input : inputs) {
    frames = std::max<int64_t>(frames, input.leader.frame_count());
  }
  const int64_t width = 3 * int64_t{inputs.front().leader.joint_count()};
  const std::vector<int64_t> shape = {static_cast<int64_t>(inputs.size()), frames, width};
  NoiseNumbers numbers{torch::zeros(shape), torch::zeros(shape),
                       torch::zeros({shape[0], 1, 1}, torch::kBool),
                       torch::zeros({shape[0], 1, width})};
  for (std::size_t n = 0; n < inputs.size(); ++n) {
    if (inputs[n].sampling.first_frame.has_value()) {
      DrawEndless(inputs[n], static_cast<int64_t>(n), frame_length, &numbers);
      continue;
    }
    base::Random random(inputs[n].sampling.seed, 0);
    const int64_t first = static_cast<int64_t>(n) * frames * width;
    const int64_t count = inputs[n].leader.frame_count() * width;
    Fill(count, &random, numbers.smooth.data_ptr<float>() + first);
    Fill(count, &random, numbers.white.data_ptr<float>() + first);
  }
  return numbers;
}

NoiseNumbers RandomNumbers(const torch::Tensor& motion, const torch::Tensor& endless,
                           double frame_length) {
  NoiseNumbers numbers{torch::randn_like(motion), torch::randn_like(motion)};
  if (!endless.defined()) return numbers;
  const torch::Tensor root = FrameRoot(motion.size(1), frame_length, 0, motion.device());
  numbers.smooth = torch::where(endless, torch::matmul(root, numbers.smooth), numbers.smooth);
  numbers.endless = endless;
  numbers.constant = torch::randn_like(motion.narrow(1, 0, 1));
  return numbers;
}

torch::Tensor SourceNoise(const checkpoint::FlowArchitecture::Noise& options,
                          const torch::Tensor& roots, const torch::Tensor& known_count,
                          const NoiseNumbers& numbers) {
  const int64_t frames = numbers.smooth.size(1);
  const auto smooth = [&](double constant, int64_t state) {
    torch::Tensor smoothed = torch::matmul(
        FrameRoot(frames, options.frame_length, constant, roots.device()), numbers.smooth);
    if (numbers.endless.defined()) {
      const torch::Tensor endless =
          state == 0
              ? std::sqrt(constant) * numbers.constant + std::sqrt(1 - constant) * numbers.smooth
              : LeaveKnown(numbers.smooth, known_count, options.frame_length);
      smoothed = torch::where(numbers.endless, endless, smoothed);
    }
    return torch::matmul(smoothed, roots[state]);
  };
  const torch::Tensor told = (known_count > 0).view({-1, 1, 1});
  torch::Tensor ramp = Ramp(known_count, frames, options.ramp_frames);
  if (numbers.endless.defined()) ramp = torch::where(numbers.endless, torch::ones_like(ramp), ramp);
  return torch::where(told, ramp * smooth(0, 1), smooth(options.constant_share, 0)) +
         options.white * numbers.white;
}

}  // namespace duet::network
