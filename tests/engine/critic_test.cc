#include "model/engine/critic.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "gmock/gmock.h"
#include "tests/support/bodies.h"

namespace duet::engine {
namespace {

using motion::Poses;
using motion::Vec3;
using test::Changed;
using test::kFrames;
using test::kRate;
using test::Puppet;

constexpr int kClasses = 2;

std::vector<float> Labels() {
  std::vector<float> labels;
  for (int t = 0; t < kFrames; ++t) labels.insert(labels.end(), {0.5f, -1});
  return labels;
}

Poses Follower() {
  return Changed(Puppet(), [](int t, Vec3 joint) {
    return joint + Vec3{0.02f * static_cast<float>(t), 0, 1};
  });
}

std::vector<float> Input(const Poses& leader, const Poses& follower) {
  return CriticInput(motion::SbuSkeleton(), kRate, leader, follower, Labels());
}

int Columns() { return CriticInputs(motion::SbuSkeleton(), kClasses); }

TEST(CriticInput, HasPositionsVelocitiesAndLabels) {
  const std::vector<float> input = Input(Puppet(), Follower());
  const int block = static_cast<int>(std::lround(kCriticFrameSeconds * kRate));
  ASSERT_EQ(input.size(), static_cast<std::size_t>(kFrames / block * Columns()));
  const int root = motion::SbuSkeleton().root;
  const auto at = [&](int part, int joint) {
    const std::size_t i = static_cast<std::size_t>((part * 15 + joint) * 3);
    return Vec3{input[i], input[i + 1], input[i + 2]};
  };
  EXPECT_GT(at(0, root).z, 0.5f);  // in front of the leader
  EXPECT_EQ(at(1, root), Vec3{});
  EXPECT_NEAR(Norm(at(2, root)), 0.5 * 0.02 * kRate, 1e-3);
  EXPECT_EQ(input[static_cast<std::size_t>(Columns() - 2)], 0.5f);
  EXPECT_EQ(input[static_cast<std::size_t>(Columns() - 1)], -1);
}

TEST(CriticInput, DoesNotDependOnPlaceOrDirection) {
  const auto moved = [](const Poses& poses) {
    return Changed(poses, [](int, Vec3 p) { return Vec3{p.z + 3, p.y, -p.x - 2}; });
  };
  const std::vector<float> input = Input(Puppet(), Follower());
  const std::vector<float> elsewhere = Input(moved(Puppet()), moved(Follower()));
  ASSERT_EQ(input.size(), elsewhere.size());
  for (std::size_t i = 0; i < input.size(); ++i) EXPECT_NEAR(input[i], elsewhere[i], 1e-4);
}

// Weights by a rule, large enough that every layer matters.
CriticWeights Weights() {
  const std::size_t inputs = static_cast<std::size_t>(Columns());
  int n = 0;
  const auto some = [&n](std::size_t count) {
    std::vector<float> values(count);
    for (float& value : values) value = static_cast<float>((31 * n++) % 17 - 8) / 64;
    return values;
  };
  constexpr std::size_t kSquare = std::size_t{kCriticUnits} * kCriticUnits * kCriticKernel;
  return {some(kCriticUnits * inputs),
          some(kCriticUnits),
          some(kSquare),
          some(kCriticUnits),
          some(kSquare),
          some(kCriticUnits),
          some(kCriticUnits),
          some(1)};
}

using Rows = std::vector<std::vector<double>>;  // [frames, units]

Rows ConvolvedByFormula(const Rows& x, const std::vector<float>& weight,
                        const std::vector<float>& bias, int dilation) {
  Rows out = x;
  const int frames = static_cast<int>(x.size());
  for (int t = 0; t < frames; ++t) {
    for (int u = 0; u < kCriticUnits; ++u) {
      double sum = double{bias[static_cast<std::size_t>(u)]};
      for (int i = 0; i < kCriticUnits; ++i) {
        for (int k = 0; k < kCriticKernel; ++k) {
          const int from = t + (k - 1) * dilation;
          if (from < 0 || from >= frames) continue;
          const auto w = static_cast<std::size_t>((u * kCriticUnits + i) * kCriticKernel + k);
          sum += double{weight[w]} * x[static_cast<std::size_t>(from)][static_cast<std::size_t>(i)];
        }
      }
      out[static_cast<std::size_t>(t)][static_cast<std::size_t>(u)] += std::max(0.0, sum);
    }
  }
  return out;
}

TEST(Critic, ScoresByItsFormula) {
  const CriticWeights w = Weights();
  const std::vector<float> input = Input(Puppet(), Follower());
  const std::size_t columns = static_cast<std::size_t>(Columns());
  Rows x(input.size() / columns, std::vector<double>(kCriticUnits));
  for (std::size_t t = 0; t < x.size(); ++t) {
    for (std::size_t u = 0; u < kCriticUnits; ++u) {
      double sum = double{w.frames_bias[u]};
      for (std::size_t i = 0; i < columns; ++i) {
        sum += double{w.frames_weight[u * columns + i]} * double{input[t * columns + i]};
      }
      x[t][u] = std::max(0.0, sum);
    }
  }
  x = ConvolvedByFormula(x, w.near_weight, w.near_bias, 1);
  x = ConvolvedByFormula(x, w.far_weight, w.far_bias, kCriticDilation);
  double score = 0;
  for (const std::vector<double>& row : x) {
    for (std::size_t u = 0; u < kCriticUnits; ++u) score += row[u] * double{w.output_weight[u]};
  }
  score = score / static_cast<double>(x.size()) + double{w.output_bias[0]};
  const Critic critic(motion::SbuSkeleton(), kRate, w);
  EXPECT_NEAR(critic.Score(Puppet(), Follower(), Labels()), score, 1e-4 * (1 + std::abs(score)));
  EXPECT_GT(std::abs(score), 0.01);
}

}  // namespace
}  // namespace duet::engine
