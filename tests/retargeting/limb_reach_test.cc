#include <cmath>

#include "gtest/gtest.h"
#include "model/retargeting/limb_ends.h"

namespace duet::retargeting {
namespace {

void ExpectNear(Vec3d a, Vec3d b, double tolerance = 1e-6) {
  EXPECT_NEAR(Norm(a - b), 0, tolerance) << a.x << " " << a.y << " " << a.z;
}

TEST(ReachFor, EndsAtTheTargetWithTheJointOnThePolesSide) {
  const Vec3d start = {1, 2, 3}, target = {1.1, 1.5, 3.1};
  const LimbPose pose = ReachFor(start, target, 0.4, 0.3, {0, 0, 1});
  ExpectNear(start + pose.upper * 0.4 + pose.lower * 0.3, target);
  EXPECT_GT(Dot(pose.upper, {0, 0, 1}), 0.3);
  EXPECT_NEAR(Dot(pose.hinge, pose.upper), 0, 1e-9);
  EXPECT_GT(Dot(Cross(pose.upper, pose.lower), pose.hinge), 0);
}

TEST(ReachFor, PointsAtATargetThatIsTooFarOrTooNear) {
  const LimbPose far = ReachFor({}, {0, -5, 0}, 0.4, 0.3, {0, 0, 1});
  ExpectNear(far.upper * 0.4 + far.lower * 0.3, {0, -0.7, 0}, 1e-3);
  const LimbPose near = ReachFor({}, {0, -0.01, 0}, 0.4, 0.3, {0, 0, 1});
  ExpectNear(near.upper * 0.4 + near.lower * 0.3, {0, -0.1, 0}, 1e-3);
}

TEST(PoleTracker, ABentLimbDefinesItsSideAndAStraightOneKeepsIt) {
  PoleTracker pole;
  const Vec3d hip = {0, 1, 0};
  ExpectNear(pole.Follow(hip, {0, 0.6, 0.25}, {0, 0.2, 0}, {1, 0, 0}), {0, 0, 1});
  // Straight, and by noise a little to the other side.
  ExpectNear(pole.Follow(hip, {0, 0.6, -0.01}, {0, 0.2, 0}, {1, 0, 0}), {0, 0, 1});
}

TEST(PoleTracker, BeginsWithTheSpecifiedDirection) {
  ExpectNear(PoleTracker().Follow({0, 1, 0}, {0, 0.5, 0}, {0, 0, 0}, {0, 0.5, -1}), {0, 0, -1});
}

TEST(PoleTracker, TheSideTurnsWithTheLimb) {
  PoleTracker pole;
  pole.Follow({}, {0, -0.4, 0.2}, {0, -0.8, 0}, {0, 0, 1});
  // Straight ahead now: what was the front is above.
  ExpectNear(pole.Follow({}, {0, 0, 0.4}, {0, 0, 0.8}, {1, 0, 0}), {0, 1, 0});
}

}  // namespace
}  // namespace duet::retargeting
