#include "model/evaluation/experiments/live_hour.h"

#include <gtest/gtest.h>

#include "model/authoring/made_leaders.h"
#include "model/motion/vec3.h"

namespace duet::evaluation::experiments {
namespace {

constexpr double kLiveRate = 15;
constexpr int kMinute = 900;

// The leader, a metre away.
motion::Poses Beside(motion::Poses leader) {
  for (motion::Vec3& p : leader.all()) p.x += 1;
  return leader;
}

TEST(LiveHourTest, AFollowerWhoStandsBesideItsLeader) {
  const motion::Poses leader = authoring::MakeLeader("idle", 150, kLiveRate);
  const LiveHourFigures figures =
      MeasureLiveHour(motion::SbuSkeleton(), leader, Beside(leader), kLiveRate);
  EXPECT_LT(figures.trunk_lean, 5);
  EXPECT_NEAR(figures.nearest, 1, 1e-3);
  EXPECT_NEAR(figures.farthest, 1, 1e-3);
  EXPECT_EQ(figures.out_of_range, 0);
  EXPECT_LT(figures.feet, 0.01);
  EXPECT_NEAR(figures.last_speed / figures.first_speed, 1, 0.05);
}

TEST(LiveHourTest, WhatHappensInBetweenCounts) {
  const motion::Poses leader = authoring::MakeLeader("idle", 200, kLiveRate);
  motion::Poses follower = Beside(leader);
  for (int t = 1000; t < 1030; ++t) {  // lies in the air
    for (motion::Vec3& p : follower[t]) p = {p.y + 1, 0.3f, p.z};
  }
  for (int t = 1100; t < 1250; ++t) {
    for (motion::Vec3& p : follower[t]) p.x += t < 1200 ? 2 : -0.9f;
  }
  const LiveHourFigures figures =
      MeasureLiveHour(motion::SbuSkeleton(), leader, follower, kLiveRate);
  EXPECT_NEAR(figures.trunk_lean, 90, 5);
  EXPECT_NEAR(figures.nearest, 0.1, 1e-3);
  EXPECT_NEAR(figures.farthest, 3, 1e-3);
  EXPECT_NEAR(figures.out_of_range, 150.0 / follower.frame_count(), 1e-9);
  EXPECT_NEAR(figures.longest_outside, 150 / kLiveRate, 1e-9);
  EXPECT_NEAR(figures.feet, 0.3, 0.01);
}

TEST(LiveHourTest, FeetBelowTheFloorCount) {
  const motion::Poses leader = authoring::MakeLeader("idle", 70, kLiveRate);
  motion::Poses follower = Beside(leader);
  for (motion::Vec3& p : follower[500]) p.y -= 0.2f;
  EXPECT_NEAR(MeasureLiveHour(motion::SbuSkeleton(), leader, follower, kLiveRate).feet, 0.2, 0.02);
}

TEST(LiveHourTest, TheFirstAndTheLastMinuteAreMeasured) {
  const motion::Poses leader = authoring::MakeLeader("dance", 200, kLiveRate);
  motion::Poses follower = Beside(leader);
  for (int t = follower.frame_count() - kMinute; t < follower.frame_count(); ++t) {
    for (int j = 0; j < follower.joint_count(); ++j) follower.at(t, j) = follower.at(1500, j);
  }
  const LiveHourFigures figures =
      MeasureLiveHour(motion::SbuSkeleton(), leader, follower, kLiveRate);
  EXPECT_GT(figures.first_speed, 0.3);
  EXPECT_NEAR(figures.last_speed, 0, 1e-6);
}

}  // namespace
}  // namespace duet::evaluation::experiments
