#include <gtest/gtest.h>

#include <cmath>

#include "model/network/losses.h"

namespace duet::network {
namespace {

torch::Tensor Lengths(std::vector<int64_t> lengths) { return torch::tensor(lengths); }

TEST(EnergyScore, IsTheErrorMinusHalfTheSpread) {
  // One clip of two frames; the answers are 3 and 1 to the right of it, 2 apart.
  const torch::Tensor real = torch::zeros({1, 2, 3});
  torch::Tensor answers = torch::zeros({2, 1, 2, 3});
  answers[0].select(2, 0).fill_(3);
  answers[1].select(2, 0).fill_(1);
  EXPECT_NEAR(EnergyScores(answers, real, Lengths({2}))[0].item<float>(), 2 - 0.5 * 2, 1e-3);
}

TEST(EnergyScore, IgnoresPadding) {
  const torch::Tensor real = torch::randn({2, 9, 3});
  torch::Tensor answers = torch::randn({2, 2, 9, 3});
  const torch::Tensor lengths = Lengths({9, 8});
  const torch::Tensor before = torch::stack({EnergyScores(answers, real, lengths),
                                             VelocityEnergyScores(answers, real, lengths),
                                             BlockEnergyScores(answers, real, lengths, 3)});
  answers.select(1, 1).select(1, 8).fill_(100);
  const torch::Tensor after = torch::stack({EnergyScores(answers, real, lengths),
                                            VelocityEnergyScores(answers, real, lengths),
                                            BlockEnergyScores(answers, real, lengths, 3)});
  EXPECT_TRUE(torch::equal(before, after));
}

TEST(EnergyScore, IsSmallestForTheSpreadOfTheRealMotion) {
  torch::manual_seed(3);
  constexpr int64_t kClips = 4000;
  const torch::Tensor real = torch::randn({kClips, 1, 2});
  const auto score = [&](double spread) {
    return EnergyScores(spread * torch::randn({2, kClips, 1, 2}), real,
                        torch::ones({kClips}, torch::kInt64))
        .mean()
        .item<double>();
  };
  EXPECT_LT(score(1), score(0.4));
  EXPECT_LT(score(1), score(2));
}

TEST(EnergyScore, BlockScoreMeasuresDependenceOverTime) {
  // Motions that keep one direction, and answers that change direction at random in every frame:
  // they are equal frame by frame, but not over time.
  torch::manual_seed(4);
  constexpr int64_t kClips = 2000, kFrames = 7;
  const auto lasting = [&] {
    return torch::randn({kClips, 1, 1}).sign() * torch::ones({kFrames, 1});
  };
  const auto fickle = [&] { return torch::randn({kClips, kFrames, 1}).sign(); };
  const auto walk = [](const torch::Tensor& steps) { return steps.cumsum(-2); };
  const torch::Tensor real = walk(lasting()), lengths = torch::full({kClips}, kFrames);
  const torch::Tensor alike = walk(torch::stack({lasting(), lasting()}));
  const torch::Tensor other = walk(torch::stack({fickle(), fickle()}));
  EXPECT_NEAR(VelocityEnergyScores(alike, real, lengths).mean().item<float>(),
              VelocityEnergyScores(other, real, lengths).mean().item<float>(), 0.05);
  EXPECT_LT(BlockEnergyScores(alike, real, lengths, 4).mean().item<float>(),
            BlockEnergyScores(other, real, lengths, 4).mean().item<float>() - 0.1);
}

// A motion of one clip, two feet (or hands), given as [frames][joints].
torch::Tensor Motion(const std::vector<std::vector<std::vector<float>>>& frames) {
  std::vector<float> values;
  for (const auto& frame : frames) {
    for (const auto& joint : frame) values.insert(values.end(), joint.begin(), joint.end());
  }
  const int64_t count = static_cast<int64_t>(frames.size());
  return torch::tensor(values).view({1, count, -1});
}

TEST(FootMotions, TellAFootThatStandsFromOneThatMoves) {
  const motion::JointPair feet = {1, 2};  // joint 0 is no foot
  const torch::Tensor motion =
      Motion({{{0, 0, 0}, {5, 0, 0}, {7, 0, 0}}, {{9, 9, 9}, {5, 0, 0.01}, {7, 40, 0}}});
  const torch::Tensor motions = FootMotions(motion, feet, 1);
  EXPECT_EQ(motions.sizes(), (std::vector<int64_t>{1, 1, 6}));
  const float* values = motions.data_ptr<float>();
  EXPECT_NEAR(values[2], 0.01, 1e-4);
  EXPECT_NEAR(values[4], 1, 1e-3);
  EXPECT_EQ(values[0] + values[1] + values[3] + values[5], 0);
}

TEST(HandPlaces, AreVectorsBetweenAllHandsThatSaturate) {
  const motion::JointPair hands = {0, 1};
  const torch::Tensor follower = Motion({{{0.1, 0, 0}, {100, 0, 0}}});
  const torch::Tensor leader = Motion({{{0, 0, 0}, {0, 1, 0}}});
  const torch::Tensor answers = torch::stack({follower, follower});
  const torch::Tensor places = HandPlaces(answers, leader, hands, 0.1);
  EXPECT_EQ(places.sizes(), (std::vector<int64_t>{2, 1, 1, 12}));
  const float* values = places.data_ptr<float>();
  EXPECT_NEAR(values[0], std::sqrt(0.5), 1e-4);                   // left to left: 0.1 apart
  EXPECT_NEAR(values[4], -1 / std::sqrt(1 + 0.01 + 0.01), 1e-4);  // leader's right to left
  EXPECT_NEAR(values[6], 1, 1e-4);                                // far
}

}  // namespace
}  // namespace duet::network
