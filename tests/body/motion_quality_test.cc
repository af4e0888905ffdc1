#include "model/body/motion_quality.h"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(BoneLengthDriftTest, ToleratesACollapsedBone) {
  EXPECT_EQ(BoneLengthDrift(motion::Poses(2, 3), Stilts()), 0);
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

TEST(FootSlideTest, FloorIsTheLowestPointOfEitherFoot) {
  for (const float floor : {-3.0f, 3.0f}) {
    // At 10 Hz: a step of 10 cm on the floor; the other foot half a metre above it.
    const motion::Poses poses(3, {{0, floor + 1, 0},
                                  {0, floor, 0},
                                  {0, floor + 0.5f, 0},  //
                                  {0, floor + 1, 0},
                                  {0.1f, floor, 0},
                                  {1, floor + 0.5f, 0}});
    EXPECT_EQ(MeasureFootSlide(poses, Stilts(), 10).skating_ratio, 1) << floor;
    EXPECT_NEAR(MeasureFootSlide(poses, Stilts(), 10).centimetres_a_frame, 10, 1e-4) << floor;
  }
}

TEST(FootSlideTest, IsNotComputedWithoutFeet) {
  motion::Skeleton footless = Stilts();
  footless.feet.reset();
  const FootSlide slide = MeasureFootSlide(motion::Poses(2, 3), footless, 10);
  EXPECT_TRUE(std::isnan(slide.skating_ratio));
  EXPECT_TRUE(std::isnan(slide.centimetres_a_frame));
}

TEST(FootSlideTest, IgnoresLiftedFeetAndVerticalMovement) {
  const motion::Poses lifted(3, {{0, 1, 0},
                                 {0, 0, 0},
                                 {0, 0.3f, 0},  //
                                 {0, 1, 0},
                                 {1, 0.06f, 0},
                                 {1, 0.3f, 0}});
  EXPECT_EQ(MeasureFootSlide(lifted, Stilts(), 10).skating_ratio, 0);
  EXPECT_EQ(MeasureFootSlide(lifted, Stilts(), 10).centimetres_a_frame, 0);
  const motion::Poses stamped(3, {{0, 1, 0},
                                  {0, 0.04f, 0},
                                  {0, 0.3f, 0},  //
                                  {0, 1, 0},
                                  {0, 0, 0},
                                  {0, 0.3f, 0}});
  EXPECT_EQ(MeasureFootSlide(stamped, Stilts(), 100).centimetres_a_frame, 0);
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

}  // namespace
}  // namespace duet::body
