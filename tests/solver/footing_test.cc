#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "model/solver/feet.h"
#include "tests/solver/noisy_person.h"

namespace duet::solver {
namespace {

using motion::Vec3;
using ::testing::Each;

FootPath Still(int frames, Vec3 at) { return FootPath(static_cast<std::size_t>(frames), at); }

// Whether a foot is at one place from frame `begin` to `end`, exclusive.
bool IsAtRest(const FootPath& path, int begin, int end) {
  return std::all_of(path.begin() + begin, path.begin() + end,
                     [&](Vec3 at) { return at == path[static_cast<std::size_t>(begin)]; });
}

TEST(FootingTest, AFootThatShiversStandsAtItsMeanPlace) {
  FootPath left = Still(30, {0.1f, 0.01f, 0});
  for (std::size_t t = 0; t < left.size(); ++t) left[t].x += t % 2 == 0 ? 0.02f : -0.02f;
  const Footing footing = PlanFooting({left, Still(30, {-0.1f, 0, 0})}, kRate, 0);
  EXPECT_THAT(footing.standing[0], Each(true));
  EXPECT_TRUE(IsAtRest(footing.paths[0], 0, 30));
  EXPECT_NEAR(footing.paths[0][0].x, 0.1f, 1e-5);
  EXPECT_NEAR(footing.paths[0][0].y, 0.01f, 1e-6);
}

TEST(FootingTest, AStepIsASwingBetweenTwoStands) {
  FootPath left = Still(40, {0, 0, 0});
  for (int t = 15; t < 40; ++t) {
    const float u = std::min(1.0f, static_cast<float>(t - 14) / 6);
    left[static_cast<std::size_t>(t)] = {0, 0.5f * u * (1 - u), 0.6f * u};
  }
  const Footing footing = PlanFooting({left, Still(40, {0.2f, 0, 0.3f})}, kRate, 0);
  EXPECT_FALSE(footing.standing[0][17]);
  EXPECT_EQ(footing.paths[0][17], left[17]);
  EXPECT_TRUE(IsAtRest(footing.paths[0], 0, 13));
  EXPECT_TRUE(IsAtRest(footing.paths[0], 23, 40));
  EXPECT_NEAR(footing.paths[0][39].z, 0.6f, 0.02);
  EXPECT_THAT(footing.standing[1], Each(true));
}

TEST(FootingTest, ASlowSlideBecomesAStepOrAStandButNotASlide) {
  FootPath left;
  for (int t = 0; t < 60; ++t) left.push_back({0, 0, 0.01f * static_cast<float>(t)});
  const Footing footing = PlanFooting({left, Still(60, {0.2f, 0, 0})}, kRate, 0);
  for (std::size_t t = 1; t < left.size(); ++t) {
    if (footing.standing[0][t] && footing.standing[0][t - 1]) {
      EXPECT_EQ(footing.paths[0][t], footing.paths[0][t - 1]) << t;
    }
  }
  // It went 59 cm: one place would be too far from its path.
  EXPECT_GT(Distance(footing.paths[0].front(), footing.paths[0].back()), 0.3f);
}

TEST(FootingTest, NobodyGlidesOnTwoSwingingFeet) {
  FootPath left, right;
  for (int t = 0; t < 30; ++t) {
    left.push_back({0, 0, 0.06f * static_cast<float>(t)});
    right.push_back({0.2f, 0.01f, 0.08f * static_cast<float>(t)});
  }
  const Footing footing = PlanFooting({left, right}, kRate, 0);
  for (std::size_t t = 0; t < left.size(); ++t) {
    EXPECT_TRUE(footing.standing[0][t] || footing.standing[1][t]) << t;
  }
}

TEST(FootingTest, AJumpHasNoStand) {
  FootPath left = Still(30, {0, 0, 0}), right = Still(30, {0.2f, 0, 0});
  for (std::size_t t = 10; t < 20; ++t) left[t].y = right[t].y = 0.4f;
  const Footing footing = PlanFooting({left, right}, kRate, 0);
  EXPECT_FALSE(footing.standing[0][15]);
  EXPECT_FALSE(footing.standing[1][15]);
  EXPECT_TRUE(footing.standing[0][2] && footing.standing[0][27]);
}

TEST(FootingTest, AStandIsNearTheFloor) {
  const Footing footing =
      PlanFooting({Still(10, {0, -0.03f, 0}), Still(10, {0.2f, 0.07f, 0})}, kRate, 0);
  EXPECT_NEAR(footing.paths[0][5].y, -0.005f, 1e-6);
  EXPECT_NEAR(footing.paths[1][5].y, 0.05f, 1e-6);
}

TEST(FootingTest, OneFrame) {
  const Footing footing = PlanFooting({Still(1, {0, 0, 0}), Still(1, {0.2f, 0, 0})}, kRate, 0);
  EXPECT_EQ(footing.paths[0].size(), 1u);
  EXPECT_TRUE(footing.standing[0][0]);
}

}  // namespace
}  // namespace duet::solver
