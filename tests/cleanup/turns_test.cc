#include "model/cleanup/turns.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gtest/gtest.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;
using Track = std::vector<Vec3>;

constexpr float kMost = 0.2f;

Vec3 Direction(float radians) { return {std::sin(radians), 0, std::cos(radians)}; }

// Turns at once by `radians` in the middle of 40 frames.
Track Sudden(float radians) {
  Track track(40, Direction(0));
  for (std::size_t t = 20; t < 40; ++t) track[t] = Direction(radians);
  return track;
}

Track Limited(Track track, int first = 0) {
  LimitTurns(first, kMost, &track);
  return track;
}

float FastestTurn(const Track& track) {
  float fastest = 0;
  for (std::size_t t = 1; t < track.size(); ++t) {
    fastest = std::max(
        fastest, std::atan2(Norm(Cross(track[t - 1], track[t])), Dot(track[t - 1], track[t])));
  }
  return fastest;
}

TEST(LimitTurns, LeavesASlowTrackAsItIs) {
  Track track;
  for (int t = 0; t < 40; ++t) track.push_back(Direction(0.19f * static_cast<float>(t)));
  EXPECT_EQ(Limited(track), track);
}

TEST(LimitTurns, ASuddenTurnTakesTimeBeforeAndAfter) {
  const Track limited = Limited(Sudden(1.6f));
  EXPECT_GT(FastestTurn(Sudden(1.6f)), 1.5f);
  EXPECT_LT(FastestTurn(limited), 1.01f * kMost);
  EXPECT_EQ(limited.front(), Direction(0));
  EXPECT_LT(Distance(limited.back(), Direction(1.6f)), 1e-4f);
  EXPECT_GT(Distance(limited[18], Direction(0)), 0.1f);     // begins before it
  EXPECT_GT(Distance(limited[21], Direction(1.6f)), 0.1f);  // ends after it
}

TEST(LimitTurns, DirectionsKeepLengthOneThroughAReversal) {
  const Track limited = Limited(Sudden(3.14159265f));
  for (const Vec3 direction : limited) EXPECT_NEAR(Norm(direction), 1, 1e-4);
  EXPECT_LT(FastestTurn(limited), 1.01f * kMost);
}

TEST(LimitTurns, FramesBeforeTheFirstDoNotChange) {
  const Track track = Sudden(1.6f), limited = Limited(track, 20);
  for (std::size_t t = 0; t < 20; ++t) EXPECT_EQ(limited[t], track[t]);
  EXPECT_LT(FastestTurn(limited), 1.01f * kMost);
  EXPECT_LT(Distance(limited.back(), track.back()), 1e-4f);
}

std::vector<float> Step(float height) {
  std::vector<float> track(40, 0.0f);
  for (std::size_t t = 20; t < 40; ++t) track[t] = height;
  return track;
}

float Steepest(const std::vector<float>& track) {
  float steepest = 0;
  for (std::size_t t = 1; t < track.size(); ++t) {
    steepest = std::max(steepest, std::abs(track[t] - track[t - 1]));
  }
  return steepest;
}

TEST(LimitSlopes, AStepTakesTimeBeforeAndAfter) {
  std::vector<float> track = Step(1);
  LimitSlopes(0, kMost, &track);
  EXPECT_LT(Steepest(track), 1.01f * kMost);
  EXPECT_EQ(track.front(), 0);
  EXPECT_EQ(track.back(), 1);
  EXPECT_GT(track[18], 0.05f);
  EXPECT_LT(track[21], 0.95f);
}

TEST(LimitSlopes, LeavesGentleTracksAndTheFramesBeforeTheFirst) {
  std::vector<float> gentle = Step(0.19f);
  LimitSlopes(0, kMost, &gentle);
  EXPECT_EQ(gentle, Step(0.19f));
  std::vector<float> late = Step(1);
  LimitSlopes(20, kMost, &late);
  for (std::size_t t = 0; t < 20; ++t) EXPECT_EQ(late[t], 0);
  EXPECT_LT(Steepest(late), 1.01f * kMost);
  EXPECT_EQ(late.back(), 1);
}

TEST(LimitSteps, AJumpTakesTimeBeforeAndAfter) {
  const Vec3 way = {0.6f, 0, 0.8f};
  Track jump(20, Vec3{}), limited;
  jump.resize(40, way);
  limited = jump;
  LimitSteps(0, kMost, &limited);
  for (std::size_t t = 1; t < 40; ++t) {
    EXPECT_LT(Distance(limited[t - 1], limited[t]), 1.01f * kMost) << t;
  }
  EXPECT_EQ(limited.front(), Vec3{});
  EXPECT_EQ(limited.back(), way);
  EXPECT_GT(Norm(limited[18]), 0.05f);           // begins before it
  EXPECT_GT(Distance(limited[21], way), 0.05f);  // ends after it
  Track slow = limited;
  LimitSteps(0, 1.01f * kMost, &slow);
  EXPECT_EQ(slow, limited);
}

TEST(SignedAngle, IsPositiveAboutItsAxis) {
  EXPECT_NEAR(SignedAngle({0, 0, 1}, {1, 0, 0}, {0, 1, 0}), 1.5708, 1e-4);
  EXPECT_NEAR(SignedAngle({1, 0, 0}, {0, 0, 1}, {0, 1, 0}), -1.5708, 1e-4);
}

}  // namespace
}  // namespace duet::cleanup
