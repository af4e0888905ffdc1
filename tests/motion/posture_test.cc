#include "model/motion/posture.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/support/matchers.h"

namespace duet::motion {
namespace {

// Root, neck and two feet.
Skeleton Figure() {
  Skeleton skeleton;
  skeleton.joint_names = {"root", "neck", "left_foot", "right_foot"};
  skeleton.bones = {{0, 1}, {0, 2}, {0, 3}};
  skeleton.feet = JointPair{2, 3};
  return skeleton;
}

TEST(StandingDirectionsTest, PointFromTheFeetToTheNeck) {
  const Poses poses(4, {{9, 9, 9}, {1, 3, 0}, {0, 0, 1}, {2, 0, -1}});
  EXPECT_THAT(StandingDirections(Figure(), poses), ElementsAre(Vec3{0, 1, 0}));
  Skeleton neckless = Figure();
  neckless.joint_names[1] = "head";
  const Poses leaning(4, {{1, 2, 2}, {9, 9, 9}, {0, 0, 0}, {2, 0, 0}});
  const Vec3 up = StandingDirections(neckless, leaning)[0];
  EXPECT_NEAR(up.y, std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(up.z, std::sqrt(0.5), 1e-6);
}

TEST(StandingDirectionsTest, NeedFeetAndABody) {
  Skeleton footless = Figure();
  footless.feet.reset();
  EXPECT_THAT(StandingDirections(footless, Poses(3, 4)), IsEmpty());
  EXPECT_THAT(LowerFeet(footless, Poses(3, 4)), IsEmpty());
  EXPECT_THAT(StandingDirections(Figure(), Poses(3, 4)), IsEmpty());
}

TEST(LowerFeetTest, AreTheLowerOfBothInEachFrame) {
  const Poses poses(4, {{}, {}, {1, 0.1f, 2}, {3, 0.2f, 4}, {}, {}, {5, 0.3f, 6}, {7, 0.2f, 8}});
  EXPECT_THAT(LowerFeet(Figure(), poses), ElementsAre(Vec3{1, 0.1f, 2}, Vec3{7, 0.2f, 8}));
}

TEST(RobustMeanTest, IsHardlyMovedByFarPoints) {
  const Vec3 mean =
      RobustMean({{0, 1, 0}, {0.01f, 1, 0}, {-0.01f, 1, 0}, {0, 1, 0.01f}, {5, 0, 0}});
  EXPECT_LT(Distance(mean, {0, 1, 0}), 0.02);
}

TEST(RobustMeanTest, IsTheMeanOfWhatLiesTogether) {
  EXPECT_LT(Distance(RobustMean({{0, 1, 0}, {1, 1, 0}, {0, 3, 0}, {1, 3, 0}}), {0.5f, 2, 0}), 1e-6);
  EXPECT_EQ(RobustMean({{1, 2, 3}, {1, 2, 3}}), (Vec3{1, 2, 3}));
  EXPECT_EQ(RobustMean({}), (Vec3{}));
}

TEST(LeanTest, IsTowardsXAndZInDegrees) {
  const Lean lean = LeanOf({static_cast<float>(std::tan(M_PI / 18)), 1, -1});
  EXPECT_NEAR(lean.x, 10, 1e-4);
  EXPECT_NEAR(lean.z, -45, 1e-4);
  EXPECT_NEAR(MeanLean({{0.2f, 1, 0}, {-0.2f, 1, 0}}).x, 0, 1e-6);
  EXPECT_EQ(MeanLean({}).x, 0);
}

TEST(FloorLeanTest, IsThatOfThePlaneOfMostPoints) {
  std::vector<Vec3> feet;
  for (int i = 0; i < 10; ++i) {
    for (int k = 0; k < 10; ++k) {
      const auto x = static_cast<float>(i), z = static_cast<float>(k);
      // Every eleventh foot is in the air.
      feet.push_back({x, 0.1f * x - 0.2f * z + ((10 * i + k) % 11 == 0 ? 2 : 0), z});
    }
  }
  EXPECT_NEAR(FloorLean(feet).x, -std::atan(0.1) * 180 / M_PI, 0.1);
  EXPECT_NEAR(FloorLean(feet).z, std::atan(0.2) * 180 / M_PI, 0.1);
}

TEST(FloorLeanTest, OfNoPlaneIsLevel) {
  EXPECT_EQ(FloorLean({}).x, 0);
  EXPECT_EQ(FloorLean({{0, 0, 0}, {1, 1, 0}, {2, 2, 0}}).x, 0);
}

TEST(HeightQuantileTest, IsTheHeightThatAShareIsBelow) {
  const std::vector<Vec3> points = {{0, 4, 0}, {0, 0, 0}, {0, 3, 0}, {0, 1, 0}, {0, 2, 0}};
  EXPECT_EQ(HeightQuantile(points, 0), 0);
  EXPECT_EQ(HeightQuantile(points, 0.25), 1);
  EXPECT_EQ(HeightQuantile(points, 1), 4);
}

}  // namespace
}  // namespace duet::motion
