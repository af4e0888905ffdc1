#include "model/solver/feet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

constexpr double kFloor = 0.08;
constexpr int kFrames = 60;

// A foot whose place along x is `x(t)`, at the side `z`.
template <typename X>
FootPath Path(const X& x, float z) {
  FootPath path;
  for (int t = 0; t < kFrames; ++t) path.push_back({static_cast<float>(x(t)), kFloor, z});
  return path;
}

std::array<FootPath, 2> Both(const FootPath& left, const FootPath& right) { return {left, right}; }

// Hips straight above the mean of the feet.
std::array<FootPath, 2> HipsAbove(const std::array<FootPath, 2>& feet) {
  std::array<FootPath, 2> hips = feet;
  for (int t = 0; t < kFrames; ++t) {
    const std::size_t at = static_cast<std::size_t>(t);
    for (FootPath& hip : hips) {
      hip[at].x = (feet[0][at].x + feet[1][at].x) / 2;
      hip[at].y = 0.9f;
    }
  }
  return hips;
}

float Way(const FootPath& path, int from, int to) {
  float way = 0;
  for (int t = from + 1; t < to; ++t) {
    way += Distance(path[static_cast<std::size_t>(t)], path[static_cast<std::size_t>(t - 1)]);
  }
  return way;
}

// The number of frames in which neither foot stands.
int InTheAir(const Footing& footing, int from = 0) {
  int frames = 0;
  for (std::size_t t = static_cast<std::size_t>(from); t < footing.standing[0].size(); ++t) {
    frames += !footing.standing[0][t] && !footing.standing[1][t] ? 1 : 0;
  }
  return frames;
}

TEST(PlanSteps, SlidingFeetStepOneAfterTheOther) {
  const auto slide = [](int t) { return 0.025 * t; };  // .375 m/s
  const auto feet = Both(Path(slide, 0.1f), Path(slide, -0.1f));
  const Footing footing = PlanSteps(feet, HipsAbove(feet), 0, kRate, kFloor);
  EXPECT_EQ(InTheAir(footing), 0);
  for (const std::size_t foot : {std::size_t{0}, std::size_t{1}}) {
    EXPECT_NEAR(footing.paths[foot].back().x, feet[foot].back().x, 0.3f);
    for (std::size_t t = 1; t < kFrames; ++t) {
      if (!footing.standing[foot][t] || !footing.standing[foot][t - 1]) continue;
      EXPECT_EQ(footing.paths[foot][t], footing.paths[foot][t - 1]) << t;
    }
  }
}

TEST(PlanSteps, AStepIsRaisedAndLandsWhereTheFootIsWanted) {
  const auto step = [](int t) { return t < 20 ? 0.0 : t > 26 ? 0.4 : 0.4 * (t - 20) / 6; };
  const auto rest = [](int) { return 0.2; };
  const auto feet = Both(Path(step, 0.1f), Path(rest, -0.1f));
  std::array<FootPath, 2> hips = HipsAbove(feet);
  const Footing footing = PlanSteps(feet, hips, 0, kRate, kFloor);
  float highest = 0;
  for (const Vec3 place : footing.paths[0]) highest = std::max(highest, place.y);
  EXPECT_GT(highest, static_cast<float>(kFloor) + 0.02f);
  EXPECT_NEAR(footing.paths[0].back().x, 0.4f, 0.05f);
  EXPECT_EQ(Way(footing.paths[1], 0, kFrames), 0) << "the other foot stands";
}

TEST(PlanSteps, FeetFollowHipsThatLeaveThem) {
  const auto rest = [](int) { return 0.0; };
  const auto feet = Both(Path(rest, 0.1f), Path(rest, -0.1f));
  std::array<FootPath, 2> hips = HipsAbove(feet);
  for (FootPath& hip : hips) {
    for (std::size_t t = 20; t < kFrames; ++t) hip[t].x = 0.5f;
  }
  const Footing footing = PlanSteps(feet, hips, 0, kRate, kFloor);
  for (const FootPath& path : footing.paths) EXPECT_GT(path.back().x, 0.25f);
  EXPECT_EQ(InTheAir(footing), 0);
}

TEST(PlanSteps, GivenFramesStayAndAStandingFootGoesOnStanding) {
  const auto slide = [](int t) { return t < 10 ? 0.0 : 0.004 * (t - 10); };  // too slow to step
  const auto feet = Both(Path(slide, 0.1f), Path(slide, -0.1f));
  const Footing footing = PlanSteps(feet, HipsAbove(feet), 10, kRate, kFloor);
  for (const std::size_t foot : {std::size_t{0}, std::size_t{1}}) {
    for (std::size_t t = 0; t < 10; ++t) EXPECT_EQ(footing.paths[foot][t], feet[foot][t]);
    EXPECT_EQ(footing.paths[foot][11], feet[foot][9]);
  }
}

// A plan that is made anew every few frames from its own frames goes on with its steps: no foot
// hovers, and none takes more than a step's time.
TEST(PlanSteps, AStepGoesOnWhenItIsPlannedAgain) {
  const auto slide = [](int t) { return 0.025 * t; };
  std::array<FootPath, 2> own = Both(Path(slide, 0.1f), Path(slide, -0.1f));
  const std::array<FootPath, 2> wanted = own, hips = HipsAbove(own);
  int longest = 0, swing = 0;
  for (int given = 1; given + 3 < kFrames; given += 2) {
    std::array<FootPath, 2> feet = wanted;
    for (const std::size_t foot : {std::size_t{0}, std::size_t{1}}) {
      std::copy_n(own[foot].begin(), given, feet[foot].begin());
    }
    const Footing footing = PlanSteps(feet, hips, given, kRate, kFloor);
    own = footing.paths;
    for (std::size_t t = static_cast<std::size_t>(given); t < static_cast<std::size_t>(given + 2);
         ++t) {
      EXPECT_TRUE(footing.standing[0][t] || footing.standing[1][t]) << t;
      swing = footing.standing[0][t] ? 0 : swing + 1;
      longest = std::max(longest, swing);
    }
  }
  EXPECT_LE(longest, 12);
  EXPECT_NEAR(own[0].back().x, wanted[0].back().x, 0.4f);
}

}  // namespace
}  // namespace duet::solver
