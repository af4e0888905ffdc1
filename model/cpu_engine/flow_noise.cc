#include "model/cpu_engine/flow_noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/base/random.h"
#include "model/cpu_engine/kernels/transformer.h"
#include "model/engine/frame_noise.h"

namespace duet::cpu_engine {
namespace {

// Added to the kernel's diagonal, so that rounding does not make it indefinite.
constexpr double kRidge = 1e-4;

std::size_t At(int row, int columns, int column) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
         static_cast<std::size_t>(column);
}

// [frames, frames]: the lower-triangular root (Cholesky) of
// constant + (1 - constant) exp(-(distance / length)^2 / 2). That of fewer frames is its corner.
std::vector<float> FrameRoot(int frames, double length, double constant) {
  std::vector<double> root(At(frames, frames, 0));
  for (int i = 0; i < frames; ++i) {
    for (int j = 0; j <= i; ++j) {
      const double distance = (i - j) / length;
      double sum = constant + (1 - constant) * std::exp(-0.5 * distance * distance);
      if (i == j) sum += kRidge;
      for (int k = 0; k < j; ++k) sum -= root[At(i, frames, k)] * root[At(j, frames, k)];
      root[At(i, frames, j)] = i == j ? std::sqrt(sum) : sum / root[At(j, frames, j)];
    }
  }
  return {root.begin(), root.end()};
}

std::vector<float> Transposed(const float* matrix, int width) {
  std::vector<float> transposed(At(width, width, 0));
  for (int i = 0; i < width; ++i) {
    for (int j = 0; j < width; ++j) transposed[At(j, width, i)] = matrix[At(i, width, j)];
  }
  return transposed;
}

}  // namespace

FlowNoise::FlowNoise(const checkpoint::FlowArchitecture::Noise& options,
                     const std::vector<float>& roots, int width, int frames)
    : options_(options),
      width_(width),
      frames_(frames),
      smoothing_(engine::SmoothingWeights(options.frame_length)) {
  for (int state = 0; state < 2; ++state) {
    const double constant = state == 0 ? options.constant_share : 0;
    states_[state] = {FrameRoot(frames, options.frame_length, constant),
                      {Transposed(roots.data() + At(state * width, width, 0), width),
                       {},
                       width,
                       width,
                       kernels::Precision::kFloat32}};
  }
}

float FlowNoise::Ramp(int frame, int known_frames) const {
  if (known_frames == 0) return 1;
  const float ramp = static_cast<float>(options_.ramp_frames);
  return std::clamp(static_cast<float>(frame - known_frames + 2) / ramp, 1 / ramp, 1.0f);
}

FlowNoise::Drawn FlowNoise::DrawWindow(uint64_t seed, bool known, int frames,
                                       Scratch::Use* scratch) const {
  const std::ptrdiff_t count = std::ptrdiff_t{frames} * width_;
  // First the part that becomes smooth in time, then the white part.
  float* const drawn = scratch->Take<float>(2 * count);
  double* const uniform = scratch->Take<double>(4 * count);
  base::FillOpenUniform(seed, /*part=*/0, 4 * count, uniform);
  kernels::StandardNormals(2 * count, uniform, drawn);
  std::vector<float> longer;
  if (frames > frames_) {
    longer = FrameRoot(frames, options_.frame_length, known ? 0 : options_.constant_share);
  }
  float* const panels =
      scratch->Take<float>(std::ptrdiff_t{kernels::PanelCount(width_)} * frames * kernels::kPanel);
  float* const smooth = scratch->Take<float>(count);
  kernels::PackPanels(drawn, 1, width_, width_, frames, panels);
  kernels::GemmF32({longer.empty() ? states_[known ? 1 : 0].over_frames.data() : longer.data(),
                    longer.empty() ? frames_ : frames, frames, frames},
                   panels, nullptr, {smooth, width_, width_});
  return {smooth, drawn + count};
}

FlowNoise::Drawn FlowNoise::DrawFrames(uint64_t seed, int64_t first, int known_frames, int frames,
                                       Scratch::Use* scratch) const {
  const int taps = static_cast<int>(smoothing_.size()), reach = taps / 2;
  const int rows = frames + 2 * reach;
  // A frame's own numbers: those that become smooth, then the white ones.
  const std::ptrdiff_t per_frame = 2 * std::ptrdiff_t{width_};
  float* const drawn = scratch->Take<float>(rows * per_frame);
  double* const uniform = scratch->Take<double>(2 * per_frame);
  const auto draw = [&](int64_t frame, float* out) {
    engine::FrameUniforms(seed, frame,
                          absl::MakeSpan(uniform, static_cast<std::size_t>(2 * per_frame)));
    kernels::StandardNormals(per_frame, uniform, out);
  };
  for (int row = 0; row < rows; ++row) draw(first - reach + row, drawn + row * per_frame);
  float* const constant = scratch->Take<float>(per_frame);
  draw(engine::kEveryFrame, constant);
  const double share = known_frames > 0 ? 0 : options_.constant_share;
  const float whole = static_cast<float>(std::sqrt(share));
  const float moving = static_cast<float>(std::sqrt(1 - share));
  float* const smooth = scratch->Take<float>(std::ptrdiff_t{frames} * width_);
  float* const white = scratch->Take<float>(std::ptrdiff_t{frames} * width_);
  for (int t = 0; t < frames; ++t) {
    float* const out = smooth + std::ptrdiff_t{t} * width_;
    for (int i = 0; i < width_; ++i) out[i] = whole * constant[i];
    for (int k = 0; k < taps; ++k) {
      const float weight = moving * smoothing_[static_cast<std::size_t>(k)];
      const float* const row = drawn + (t + k) * per_frame;
      for (int i = 0; i < width_; ++i) out[i] += weight * row[i];
    }
    std::copy_n(drawn + (t + reach) * per_frame + width_, width_,
                white + std::ptrdiff_t{t} * width_);
  }
  if (known_frames > 0) LeaveKnown(known_frames, frames, smooth);
  return {smooth, white};
}

void FlowNoise::LeaveKnown(int known_frames, int frames, float* smooth) const {
  float* const last = smooth + std::ptrdiff_t{known_frames - 1} * width_;
  for (int t = 0; t < frames; ++t) {
    if (t == known_frames - 1) continue;
    const double distance = (t - known_frames + 1) / options_.frame_length;
    const float share = static_cast<float>(std::exp(-0.5 * distance * distance));
    for (int i = 0; i < width_; ++i) smooth[std::ptrdiff_t{t} * width_ + i] -= share * last[i];
  }
  std::fill_n(last, width_, 0.0f);
}

void FlowNoise::Fill(const engine::Sampling& sampling, int known_frames, int frames,
                     Scratch::Use* scratch, float* out) const {
  if (sampling.variety == 0) {
    std::fill_n(out, std::ptrdiff_t{frames} * width_, 0.0f);
    return;
  }
  const bool known = known_frames > 0, endless = sampling.first_frame.has_value();
  const Drawn drawn =
      endless ? DrawFrames(sampling.seed, *sampling.first_frame, known_frames, frames, scratch)
              : DrawWindow(sampling.seed, known, frames, scratch);
  states_[known ? 1 : 0].over_joints.Multiply(frames, drawn.smooth, out);
  const float white = static_cast<float>(options_.white);
  for (int t = 0; t < frames; ++t) {
    const float ramp = endless ? 1 : Ramp(t, known_frames);
    for (std::ptrdiff_t i = std::ptrdiff_t{t} * width_; i < std::ptrdiff_t{t + 1} * width_; ++i) {
      out[i] = sampling.variety * (ramp * out[i] + white * drawn.white[i]);
    }
  }
}

}  // namespace duet::cpu_engine
