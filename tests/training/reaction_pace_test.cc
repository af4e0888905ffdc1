#include "model/training/reaction_pace.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/support/sample_motion.h"

namespace duet::training {
namespace {

using ::testing::Each;
using ::testing::Ge;
using ::testing::Le;

constexpr double kRate = 15;
constexpr int kFrames = 45;

std::vector<double> Reached(const std::vector<double>& acting, uint64_t seed) {
  base::Random random(seed);
  return ReactionFrames(acting, 0, kFrames, kRate, &random);
}

TEST(ReactionPaceTest, APersonWhoStandsRestsAndOneWhoWalksActs) {
  const motion::Poses standing = test::SteppingMotion({}, 60, kRate);
  EXPECT_THAT(ActingShares(standing, kRate), Each(0));
  motion::Poses walking = standing;
  for (int t = 0; t < 60; ++t) {
    for (motion::Vec3& joint : walking[t]) joint.x += static_cast<float>(0.8 * t / kRate);
  }
  const std::vector<double> acting = ActingShares(walking, kRate);
  ASSERT_EQ(acting.size(), 60u);
  EXPECT_EQ(acting[30], 1);
}

TEST(ReactionPaceTest, AReactionThatBeginsWithAnActingLeaderRunsAsCaptured) {
  const std::vector<double> acting(kFrames, 1);
  int from_the_start = 0;
  for (uint64_t seed = 0; seed < 40; ++seed) {
    const std::vector<double> reached = Reached(acting, seed);
    if (reached.front() > 6) continue;  // in the midst of it
    ++from_the_start;
    for (size_t t = 1; t + 10 < reached.size(); ++t) {
      EXPECT_NEAR(reached[t] - reached[t - 1], 1, 1e-9) << seed << ' ' << t;
    }
  }
  EXPECT_NEAR(from_the_start, 23, 10);  // half, and those whose midst is early
}

TEST(ReactionPaceTest, BesideALeaderWhoRestsTheFollowerGoesBackAndSways) {
  const std::vector<double> resting(150, 0);
  int recovered = 0;
  for (uint64_t seed = 0; seed < 40; ++seed) {
    base::Random random(seed);
    const std::vector<double> reached = ReactionFrames(resting, 0, 150, kRate, &random);
    for (size_t t = 1; t < reached.size(); ++t) {
      const double before = reached[t - 1];
      EXPECT_TRUE(before <= 6.7 || std::abs(reached[t] - before + 0.7) < 1e-9) << seed << ' ' << t;
    }
    if (reached.front() > 6 && reached.front() < 60) {
      ++recovered;
      EXPECT_LE(reached.back(), 6);
    }
    if (reached.front() <= 6) {
      const auto [least, most] = std::minmax_element(reached.begin(), reached.end());
      EXPECT_NEAR(*least, 0, 0.1);
      EXPECT_NEAR(*most, 6, 0.1);  // 0.4 s
    }
  }
  EXPECT_GT(recovered, 3);
}

TEST(ReactionPaceTest, AfterItsEndAReactionGoesBackAndComesAgain) {
  const std::vector<double> acting(200, 1);
  base::Random random(1);
  const std::vector<double> reached = ReactionFrames(acting, 20, 180, kRate, &random);
  EXPECT_THAT(reached, Each(Ge(0)));
  EXPECT_THAT(reached, Each(Le(179)));
  std::vector<double> early = Reached(acting, 1);
  EXPECT_LE(*std::max_element(early.begin(), early.end()), kFrames - 1);
  for (uint64_t seed = 0; seed < 40; ++seed) {
    early = Reached(acting, seed);
    if (early.front() < kFrames / 2.0) continue;
    EXPECT_LT(early.back(), kFrames - 1.5) << seed;  // on its way back
  }
}

}  // namespace
}  // namespace duet::training
