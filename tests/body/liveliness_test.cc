#include "model/body/liveliness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/body/motion_quality.h"
#include "model/motion/filter.h"

namespace duet::body {
namespace {

// One joint that stands, one that moves 0.1 m a frame along x.
motion::Poses OneMoves(int frames) {
  motion::Poses poses(frames, 2);
  for (int t = 0; t < frames; ++t) poses.at(t, 1) = {0.1f * static_cast<float>(t), 1, 0};
  return poses;
}

// To and fro by 1 cm every frame: what noise does.
motion::Poses Shaking(int frames) {
  motion::Poses poses(frames, 1);
  for (int t = 0; t < frames; ++t) poses.at(t, 0) = {t % 2 == 0 ? 0.005f : -0.005f, 0, 0};
  return poses;
}

TEST(JointSpeedTest, IsTheMeanOverJointsAndSteps) {
  EXPECT_NEAR(JointSpeed(OneMoves(5), 10), 0.5, 1e-6);
  EXPECT_NEAR(JointSpeed(OneMoves(5), 30), 1.5, 1e-6);
  EXPECT_EQ(JointSpeed(OneMoves(1), 10), 0);
}

TEST(RangeOfMotionTest, IsTheLargestDistanceFromTheFirstFrame) {
  motion::Poses there_and_back = OneMoves(5);
  there_and_back.at(4, 1) = there_and_back.at(1, 1);
  EXPECT_NEAR(RangeOfMotion(there_and_back), 0.15, 1e-6);  // 0.3 m and 0
}

TEST(JointSpeedTest, NoiseFilterKeepsSteadyMotionAndRemovesShaking) {
  EXPECT_NEAR(JointSpeed(WithoutNoise(OneMoves(20), 15), 15), JointSpeed(OneMoves(20), 15), 1e-4);
  const motion::Poses shaking = Shaking(40);
  const motion::Poses calm = WithoutNoise(shaking, 15);
  EXPECT_LT(JointSpeed(calm, 15), 0.1 * JointSpeed(shaking, 15));
  EXPECT_LT(Jitter(calm, 15), 0.05 * Jitter(shaking, 15));
}

TEST(VelocityErrorTest, ComparesStepsInMetresASecond) {
  const motion::Poses still(3, 1);
  const motion::Poses moving(1, {{9, 9, 9}, {9, 9, 10}, {9, 9, 10}});
  // One step of 1 m among two, at 15 frames a second.
  EXPECT_DOUBLE_EQ(VelocityError(moving, still, 15), 7.5);
  EXPECT_DOUBLE_EQ(VelocityError(moving, moving, 15), 0);
}

}  // namespace
}  // namespace duet::body
