#include "model/motion/posture.h"

#include <cmath>

#include "gmock/gmock.h"
#include "model/motion/feet.h"
#include "model/motion/levelling.h"
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

TEST(HeightQuantileTest, IsTheHeightThatAShareIsBelow) {
  const std::vector<Vec3> points = {{0, 4, 0}, {0, 0, 0}, {0, 3, 0}, {0, 1, 0}, {0, 2, 0}};
  EXPECT_EQ(HeightQuantile(points, 0), 0);
  EXPECT_EQ(HeightQuantile(points, 0.25), 1);
  EXPECT_EQ(HeightQuantile(points, 1), 4);
}

TEST(LowerFootTest, IsTheLowerOfBothInEachFrame) {
  Poses poses(3, 3);
  const JointPair feet{0, 2};
  for (int t = 0; t < 3; ++t) {
    poses.at(t, 0).y = static_cast<float>(t);
    poses.at(t, 1).y = -5;  // no foot
    poses.at(t, 2).y = 1.5f;
  }
  EXPECT_THAT(LowerFoot(feet, poses), ElementsAre(0, 1, 1.5f));
  EXPECT_EQ(LowestFoot(feet, poses), 0);
  poses.at(2, 2).y = -1;
  EXPECT_EQ(LowestFoot(feet, poses), -1);
  EXPECT_GT(LowestFoot(feet, Poses(0, 3)), 1e30f);
}

void ExpectNear(Vec3 a, Vec3 b, float tolerance) { EXPECT_LT(Distance(a, b), tolerance); }

TEST(LevellingTest, VerticalAndFloorComeToTheirPlaces) {
  // The camera is pitched by 10 degrees: the vertical leans along +z.
  const float angle = 10 * static_cast<float>(M_PI) / 180;
  const Levelling levelling({0, 2 * std::cos(angle), 2 * std::sin(angle)}, -0.8f);
  ExpectNear(levelling.Apply({0, std::cos(angle), std::sin(angle)}), {0, 1.8f, 0}, 1e-6f);
  // Across the view nothing turns; along it the camera's axis rises.
  ExpectNear(levelling.Apply({1, 0, 0}), {1, 0.8f, 0}, 1e-6f);
  ExpectNear(levelling.Apply({0, 0, 1}), {0, 0.8f + std::sin(angle), std::cos(angle)}, 1e-6f);
}

TEST(LevellingTest, KeepsDistancesAndHandedness) {
  const Levelling levelling({0.2f, 0.9f, -0.3f}, 1);
  const Vec3 origin = levelling.Apply({0, 0, 0});
  const Vec3 x = levelling.Apply({1, 0, 0}) - origin;
  const Vec3 y = levelling.Apply({0, 1, 0}) - origin;
  const Vec3 z = levelling.Apply({0, 0, 1}) - origin;
  ExpectNear(Cross(x, y), z, 1e-6f);
  EXPECT_NEAR(Norm(x), 1, 1e-6);
  EXPECT_NEAR(Norm(y), 1, 1e-6);
}

TEST(LevellingTest, InvertUndoesApply) {
  const Levelling levelling({0.1f, 1, 0.17f}, -0.83f);
  const Poses captured(2, {{0.3f, -0.2f, 2.5f}, {-1.2f, 0.8f, 3.4f}});
  const Poses back = levelling.Invert(levelling.Apply(captured));
  for (int j = 0; j < 2; ++j) ExpectNear(back.at(0, j), captured.at(0, j), 2e-6f);
}

}  // namespace
}  // namespace duet::motion
