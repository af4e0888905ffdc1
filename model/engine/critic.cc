#include "model/engine/critic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace duet::engine {
namespace {

using motion::Poses;
using motion::Vec3;

constexpr int kParts = 3;  // positions about two roots, and velocities
constexpr float kVelocityScale = 0.5f;

using Units = std::array<float, kCriticUnits>;

// The means of blocks of frames; frames at the end that do not fill a block are left out.
Poses BlockMeans(const Poses& poses, int block) {
  Poses means(poses.frame_count() / block, poses.joint_count());
  for (int t = 0; t < means.frame_count(); ++t) {
    for (int j = 0; j < poses.joint_count(); ++j) {
      Vec3 sum;
      for (int b = 0; b < block; ++b) sum += poses.at(t * block + b, j);
      means.at(t, j) = sum / static_cast<float>(block);
    }
  }
  return means;
}

int BlockFrames(double frame_rate_hz, int frames) {
  const int block = std::max(1, static_cast<int>(std::lround(kCriticFrameSeconds * frame_rate_hz)));
  return frames < 2 * block ? 1 : block;
}

// Turns points about the vertical so that the way from leader to follower becomes z.
class Turn {
 public:
  Turn(const Poses& leader, const Poses& follower, int root) {
    Vec3 way;
    for (int t = 0; t < leader.frame_count(); ++t) way += follower.at(t, root) - leader.at(t, root);
    const float length = std::hypot(way.x, way.z);
    if (length == 0) return;
    sine_ = way.x / length;
    cosine_ = way.z / length;
  }
  Vec3 operator()(Vec3 v) const {
    return {cosine_ * v.x - sine_ * v.z, v.y, sine_ * v.x + cosine_ * v.z};
  }

 private:
  float sine_ = 0, cosine_ = 1;
};

// Puts the inputs of a matrix [outputs, inputs, kernel] outermost: [kernel, inputs, outputs].
std::vector<float> InputsOutermost(const std::vector<float>& weight, std::size_t inputs,
                                   std::size_t kernel) {
  std::vector<float> out(weight.size());
  for (std::size_t u = 0; u < kCriticUnits; ++u) {
    for (std::size_t i = 0; i < inputs; ++i) {
      for (std::size_t k = 0; k < kernel; ++k) {
        out[(k * inputs + i) * kCriticUnits + u] = weight[(u * inputs + i) * kernel + k];
      }
    }
  }
  return out;
}

// sum += values x rows. Shapes: values [inputs], rows [inputs, U].
void AddProduct(const float* values, std::size_t inputs, const float* rows, Units* sum) {
  Units units = *sum;  // a local copy stays in registers
  for (std::size_t i = 0; i < inputs; ++i, rows += kCriticUnits) {
    const float value = values[i];
    for (std::size_t u = 0; u < kCriticUnits; ++u) units[u] += value * rows[u];
  }
  *sum = units;
}

Units Bias(const std::vector<float>& bias) {
  Units units;
  std::copy(bias.begin(), bias.end(), units.begin());
  return units;
}

void AddRelu(const Units& values, Units* sum) {
  for (std::size_t u = 0; u < kCriticUnits; ++u) (*sum)[u] += std::max(0.0f, values[u]);
}

// Frames outside the window count as zero. Shapes: weight [K, U, U].
std::vector<Units> Convolved(const std::vector<Units>& frames, const std::vector<float>& weight,
                             const std::vector<float>& bias, int dilation) {
  const int count = static_cast<int>(frames.size());
  std::vector<Units> out = frames;
  for (int t = 0; t < count; ++t) {
    Units sum = Bias(bias);
    for (int k = 0; k < kCriticKernel; ++k) {
      const int from = t + (k - kCriticKernel / 2) * dilation;
      if (from < 0 || from >= count) continue;
      AddProduct(frames[static_cast<std::size_t>(from)].data(), kCriticUnits,
                 &weight[static_cast<std::size_t>(k * kCriticUnits * kCriticUnits)], &sum);
    }
    AddRelu(sum, &out[static_cast<std::size_t>(t)]);
  }
  return out;
}

}  // namespace

int CriticInputs(const motion::Skeleton& skeleton, int classes) {
  return kParts * 3 * skeleton.joint_count() + classes;
}

std::vector<float> CriticInput(const motion::Skeleton& skeleton, double frame_rate_hz,
                               const Poses& leader, const Poses& follower,
                               absl::Span<const float> labels) {
  const int block = BlockFrames(frame_rate_hz, leader.frame_count());
  const std::size_t classes = labels.size() / static_cast<std::size_t>(leader.frame_count());
  const Poses leads = BlockMeans(leader, block), follows = BlockMeans(follower, block);
  const Turn turn(leads, follows, skeleton.root);
  const int frames = follows.frame_count();
  std::vector<float> input;
  input.reserve(
      static_cast<std::size_t>(frames * CriticInputs(skeleton, static_cast<int>(classes))));
  const auto put = [&](Vec3 v) { input.insert(input.end(), {v.x, v.y, v.z}); };
  for (int t = 0; t < frames; ++t) {
    const int before = std::max(t - 1, 0), after = std::min(t + 1, frames - 1);
    const float rate = kVelocityScale * static_cast<float>(frame_rate_hz) /
                       static_cast<float>(block * std::max(1, after - before));
    const Vec3 lead = leads.at(t, skeleton.root), own = follows.at(t, skeleton.root);
    for (const Vec3 joint : follows[t]) put(turn(joint - lead));
    for (const Vec3 joint : follows[t]) put(turn(joint - own));
    for (int j = 0; j < follows.joint_count(); ++j) {
      put(turn((follows.at(after, j) - follows.at(before, j)) * rate));
    }
    const auto weights = labels.subspan(static_cast<std::size_t>(t * block) * classes, classes);
    input.insert(input.end(), weights.begin(), weights.end());
  }
  return input;
}

Critic::Critic(motion::Skeleton skeleton, double frame_rate_hz, CriticWeights weights)
    : skeleton_(std::move(skeleton)), frame_rate_hz_(frame_rate_hz), weights_(std::move(weights)) {
  const std::size_t inputs = weights_.frames_weight.size() / kCriticUnits;
  weights_.frames_weight = InputsOutermost(weights_.frames_weight, inputs, 1);
  weights_.near_weight = InputsOutermost(weights_.near_weight, kCriticUnits, kCriticKernel);
  weights_.far_weight = InputsOutermost(weights_.far_weight, kCriticUnits, kCriticKernel);
}

float Critic::Score(const Poses& leader, const Poses& follower,
                    absl::Span<const float> labels) const {
  const std::vector<float> input = CriticInput(skeleton_, frame_rate_hz_, leader, follower, labels);
  const std::size_t inputs = weights_.frames_weight.size() / kCriticUnits;
  std::vector<Units> frames(input.size() / inputs);
  for (std::size_t t = 0; t < frames.size(); ++t) {
    Units sum = Bias(weights_.frames_bias);
    AddProduct(&input[t * inputs], inputs, weights_.frames_weight.data(), &sum);
    frames[t].fill(0);
    AddRelu(sum, &frames[t]);
  }
  frames = Convolved(frames, weights_.near_weight, weights_.near_bias, 1);
  frames = Convolved(frames, weights_.far_weight, weights_.far_bias, kCriticDilation);
  float sum = 0;
  for (const Units& frame : frames) {
    for (std::size_t u = 0; u < kCriticUnits; ++u) sum += frame[u] * weights_.output_weight[u];
  }
  return sum / static_cast<float>(frames.size()) + weights_.output_bias[0];
}

}  // namespace duet::engine
