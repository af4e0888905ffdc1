#include "model/evaluation/experiments/long_clips.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "model/authoring/made_leaders.h"
#include "model/motion/vec3.h"

namespace duet::evaluation::experiments {
namespace {

constexpr double kClipRate = 15;

TEST(LongClipsTest, MeasuresFallingAndDrifting) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  motion::Poses leader = authoring::MakeLeader("idle", 40, kClipRate);
  for (motion::Vec3& p : leader.all()) p.y += 2;  // the floor is the leader's
  const LongClipFigures upright = MeasureLongClip(skeleton, leader, leader, kClipRate);
  EXPECT_LT(upright.trunk_lean, 5);
  EXPECT_LT(upright.body_lean, 5);
  EXPECT_LT(upright.feet_above, 0.01);
  EXPECT_LT(upright.feet_below, 0.01);
  EXPECT_LT(upright.farthest, 0.01);
  EXPECT_NEAR(upright.first_speed, upright.last_speed, 0.01);
  EXPECT_LT(upright.last_lean, 5);
  EXPECT_LT(upright.last_feet, 0.01);
  // It lies in the air, 3 m away, from the middle on.
  motion::Poses follower = leader;
  for (int t = 300; t < follower.frame_count(); ++t) {
    for (motion::Vec3& p : follower[t]) p = {p.y + 3, 2.4f, p.z};
  }
  const LongClipFigures fallen = MeasureLongClip(skeleton, leader, follower, kClipRate);
  EXPECT_NEAR(fallen.trunk_lean, 90, 5);
  EXPECT_NEAR(fallen.body_lean, 90, 5);
  EXPECT_NEAR(fallen.feet_above, 0.4, 0.01);
  EXPECT_GT(fallen.farthest, 2.5);
  EXPECT_NEAR(fallen.last_lean, 90, 5);
  EXPECT_NEAR(fallen.last_feet, 0.4, 0.01);
}

TEST(LongClipsTest, LastSecondsShowWhetherItStoodUpAgain) {
  const motion::Poses leader = authoring::MakeLeader("idle", 40, kClipRate);
  motion::Poses follower = leader;
  for (int t = 200; t < 300; ++t) {
    for (motion::Vec3& p : follower[t]) p = {p.y, 0.4f, p.z};
  }
  const LongClipFigures figures =
      MeasureLongClip(motion::SbuSkeleton(), leader, follower, kClipRate);
  EXPECT_NEAR(figures.trunk_lean, 90, 5);
  EXPECT_NEAR(figures.feet_above, 0.4, 0.01);
  EXPECT_LT(figures.last_lean, 5);
  EXPECT_LT(figures.last_feet, 0.01);
}

TEST(LongClipsTest, FirstAndLastSecondsAreMeasuredSeparately) {
  const motion::Poses leader = authoring::MakeLeader("dance", 40, kClipRate);
  motion::Poses stops = leader;
  for (int t = 200; t < stops.frame_count(); ++t) {
    for (int j = 0; j < stops.joint_count(); ++j) stops.at(t, j) = stops.at(200, j);
  }
  const LongClipFigures figures = MeasureLongClip(motion::SbuSkeleton(), leader, stops, kClipRate);
  EXPECT_GT(figures.first_speed, 0.3);
  EXPECT_NEAR(figures.last_speed, 0, 1e-6);
}

TEST(LongClipsTest, TheWorstIsTheLargestLeanAndTheLeastSpeed) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const LongClipFigures worst = Worst({{"a", "idle", 0, {1, 5, 0.1, 0.4, 2, 0.3, 0.5, 7, 0.1}},
                                       {"a", "idle", 1, {3, 4, none, 0.3, 1, 0.2, 0.6, 8, none}}});
  EXPECT_EQ(worst.trunk_lean, 3);
  EXPECT_EQ(worst.body_lean, 5);
  EXPECT_EQ(worst.feet_above, 0.1);
  EXPECT_EQ(worst.feet_below, 0.4);
  EXPECT_EQ(worst.farthest, 2);
  EXPECT_EQ(worst.first_speed, 0.2);
  EXPECT_EQ(worst.last_speed, 0.5);
  EXPECT_EQ(worst.last_lean, 8);
  EXPECT_EQ(worst.last_feet, 0.1);
}

}  // namespace
}  // namespace duet::evaluation::experiments
