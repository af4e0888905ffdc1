#include "model/body/posture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/motion/vec3.h"

namespace duet::body {
namespace {

constexpr double kRate = 10;
constexpr double kRadians = M_PI / 180;

// Hips with two sides, a neck, two feet.
motion::Skeleton Figure() {
  motion::Skeleton skeleton;
  skeleton.joint_names = {"hips", "left_hip", "right_hip", "neck", "left_foot", "right_foot"};
  skeleton.bones = {{0, 1}, {0, 2}, {0, 3}, {1, 4}, {2, 5}};
  skeleton.hips = motion::JointPair{1, 2};
  skeleton.feet = motion::JointPair{4, 5};
  return skeleton;
}

// Stands on y = 0 at a place and faces -z turned by `yaw`; above the hips it leans forwards.
std::vector<motion::Vec3> Stand(motion::Vec3 at, double yaw, double lean = 0) {
  const auto forward = static_cast<float>(-std::sin(lean)), up = static_cast<float>(std::cos(lean));
  std::vector<motion::Vec3> pose = {{0, 1, 0},    {-.1f, 1, 0}, {.1f, 1, 0}, {0, 1 + up, forward},
                                    {-.1f, 0, 0}, {.1f, 0, 0}};
  for (motion::Vec3& p : pose) p = at + RotateY(p, yaw);
  return pose;
}

motion::Poses Held(const std::vector<motion::Vec3>& pose, int frames) {
  motion::Poses poses(0, static_cast<int>(pose.size()));
  for (int t = 0; t < frames; ++t) poses.Append(pose);
  return poses;
}

TEST(LeanTest, IsTheAngleFromTheVertical) {
  const motion::Poses leaning = Held(Stand({1, 2, 3}, 1, 30 * kRadians), 5);
  const Lean trunk = MeasureLean(leaning, Figure(), kRate, LeanFrom::kHips);
  EXPECT_NEAR(trunk.mean_degrees, 30, 1e-3);
  EXPECT_NEAR(trunk.max_degrees, 30, 1e-3);
  // Seen from the feet, twice as far below, it is half of it.
  EXPECT_NEAR(MeasureLean(leaning, Figure(), kRate, LeanFrom::kFeet).mean_degrees, 15, 1e-3);
}

TEST(LeanTest, TheLargestIsAMeanOverOneSecond) {
  // Upright for 2 s but for half a second at 60 degrees.
  motion::Poses poses = Held(Stand({}, 0), 10);
  poses.Append(Held(Stand({}, 0, 60 * kRadians), 5).all());
  poses.Append(Held(Stand({}, 0), 5).all());
  const Lean lean = MeasureLean(poses, Figure(), kRate, LeanFrom::kHips);
  EXPECT_NEAR(lean.mean_degrees, 15, 1e-3);
  EXPECT_NEAR(lean.max_degrees, 30, 1e-3);
}

TEST(FacingTest, IsTheAngleToTheLeader) {
  const motion::Poses leader = Held(Stand({0, 0, -2}, 0), 4);
  for (const double degrees : {0.0, 45.0, 90.0, 180.0, -45.0}) {
    const motion::Poses follower = Held(Stand({}, degrees * kRadians), 4);
    EXPECT_NEAR(FacingDegrees(leader, follower, Figure()), std::abs(degrees), 1e-2);
  }
}

TEST(RootDistanceTest, IsAlongTheFloor) {
  const motion::Poses leader = Held(Stand({}, 0), 2), follower = Held(Stand({3, 7, 4}, 0), 2);
  EXPECT_NEAR(RootDistance(leader, follower, Figure()), 5, 1e-6);
}

TEST(FloorGapTest, IsOfTheLowerFoot) {
  motion::Poses poses = Held(Stand({}, 0), 3);
  poses.at(0, 4).y = 0.9f;  // a kick: the other foot stands
  poses.at(1, 4).y = 0.3f;  // a jump
  poses.at(1, 5).y = 0.2f;
  poses.at(2, 5).y = -0.1f;  // through the floor
  const FloorGap gap = MeasureFloorGap(poses, Figure(), 0);
  EXPECT_NEAR(gap.above, 0.2, 1e-6);
  EXPECT_NEAR(gap.below, 0.1, 1e-6);
  EXPECT_NEAR(gap.mean, (0.2 + 0.1) / 3, 1e-6);
  EXPECT_NEAR(MeasureFloorGap(poses, Figure(), 0.05).above, 0.15, 1e-6);
}

TEST(PostureTest, MissingJointsGiveNaN) {
  motion::Skeleton skeleton = Figure();
  skeleton.feet.reset();
  const motion::Poses held = Held(Stand({}, 0), 2);
  EXPECT_TRUE(std::isnan(MeasureFloorGap(held, skeleton, 0).above));
  EXPECT_TRUE(std::isnan(MeasureLean(held, skeleton, kRate, LeanFrom::kFeet).mean_degrees));
}

}  // namespace
}  // namespace duet::body
