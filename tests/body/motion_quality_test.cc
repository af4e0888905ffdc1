#include "model/body/motion_quality.h"

#include <cmath>

#include "gtest/gtest.h"
#include "model/body/liveliness.h"
#include "model/motion/filter.h"

namespace duet::body {
namespace {

// A root with two feet.
motion::Skeleton Stilts() {
  motion::Skeleton skeleton;
  skeleton.joint_names = {"hips", "left", "right"};
  skeleton.bones = {{0, 1}, {0, 2}};
  skeleton.feet = motion::JointPair{1, 2};
  return skeleton;
}

TEST(BoneLengthDriftTest, IsTheCoefficientOfVariationOfEachBone) {
  // The left bone has lengths 1 and 3 (mean 2, deviation 1), the right one keeps its 2.
  const motion::Poses poses(3, {{0, 0, 0},
                                {1, 0, 0},
                                {0, 2, 0},  //
                                {5, 0, 0},
                                {8, 0, 0},
                                {5, 0, 2}});
  EXPECT_NEAR(BoneLengthDrift(poses, Stilts()), (0.5 + 0) / 2, 1e-6);
}

TEST(JitterTest, IsTheThirdDifferenceTimesRateCubed) {
  // t^3 / 6 has the third difference 1; constant acceleration has none.
  motion::Poses cubic(8, 1), parabola(8, 1), both(8, 2);
  for (int t = 0; t < 8; ++t) {
    const float s = static_cast<float>(t);
    both.at(t, 0) = cubic.at(t, 0) = {s * s * s / 6, 0, 0};
    both.at(t, 1) = parabola.at(t, 0) = {s, 3 * s * s, -s};
  }
  EXPECT_NEAR(Jitter(cubic, 2), 8, 1e-4);
  EXPECT_NEAR(Jitter(parabola, 2), 0, 1e-4);
  EXPECT_NEAR(Jitter(both, 2), 4, 1e-4);
  EXPECT_EQ(Jitter(motion::Poses(1, {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}), 2), 0);
}

TEST(FootSlideTest, CountsFastStepsOfFeetOnTheFloor) {
  // At 10 Hz. Left: a step of 10 cm (1 m/s, skating), then one of 1 cm. Right: at 0.5 m, never
  // down.
  const motion::Poses poses(3, {
                                   {0, 1, 0},
                                   {0, 0, 0},
                                   {0, 0.5f, 0},  //
                                   {0, 1, 0},
                                   {0.1f, 0.04f, 0},
                                   {1, 0.5f, 0},  //
                                   {0, 1, 0},
                                   {0.1f, 0, 0.01f},
                                   {2, 0.5f, 0},
                               });
  const FootSlide slide = MeasureFootSlide(poses, Stilts(), 10);
  EXPECT_DOUBLE_EQ(slide.skating_ratio, 0.5);
  EXPECT_NEAR(slide.centimetres_a_frame, (10 + 1) / 2.0, 1e-4);
}

TEST(FootSlideTest, IsNotComputedWithoutFeet) {
  motion::Skeleton footless = Stilts();
  footless.feet.reset();
  const FootSlide slide = MeasureFootSlide(motion::Poses(2, 3), footless, 10);
  EXPECT_TRUE(std::isnan(slide.skating_ratio));
  EXPECT_TRUE(std::isnan(slide.centimetres_a_frame));
}

// The height of either end alone does not tell: a foot that steps off or lands has swung.
TEST(FootSlideTest, CountsAStepOnlyWithTheFootOnTheFloorAtBothEnds) {
  const motion::Poses landing(3, {{0, 1, 0},
                                  {0, 0.3f, 0},
                                  {0, 0, 0},  //
                                  {0, 1, 0},
                                  {1, 0, 0},
                                  {0, 0, 0}});
  const motion::Poses leaving(3, {{0, 1, 0},
                                  {0, 0, 0},
                                  {0, 0, 0},  //
                                  {0, 1, 0},
                                  {1, 0.3f, 0},
                                  {0, 0, 0}});
  for (const motion::Poses& poses : {landing, leaving}) {
    EXPECT_EQ(MeasureFootSlide(poses, Stilts(), 10).skating_ratio, 0);
    EXPECT_EQ(MeasureFootSlide(poses, Stilts(), 10).centimetres_a_frame, 0);
  }
}

// One joint that stands, one that moves 0.1 m a frame along x.
motion::Poses OneMoves(int frames) {
  motion::Poses poses(frames, 2);
  for (int t = 0; t < frames; ++t) poses.at(t, 1) = {0.1f * static_cast<float>(t), 1, 0};
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

TEST(VelocityErrorTest, ComparesStepsInMetresASecond) {
  const motion::Poses still(3, 1);
  const motion::Poses moving(1, {{9, 9, 9}, {9, 9, 10}, {9, 9, 10}});
  // One step of 1 m among two, at 15 frames a second.
  EXPECT_DOUBLE_EQ(VelocityError(moving, still, 15), 7.5);
  EXPECT_DOUBLE_EQ(VelocityError(moving, moving, 15), 0);
}

}  // namespace
}  // namespace duet::body
