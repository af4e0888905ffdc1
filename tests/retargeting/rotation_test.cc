#include "model/retargeting/rotation.h"

#include <cmath>
#include <vector>

#include "gtest/gtest.h"
#include "model/base/angle.h"
#include "tests/support/expect_near.h"

namespace duet::retargeting {
namespace {

using base::kPi;

void ExpectNear(Vec3d a, Vec3d b) { test::ExpectNear(a, b, 1e-9); }

TEST(Rotation, TurnsCounterClockwise) {
  ExpectNear(Rotate(AxisAngle({0, 0, 1}, kPi / 2), {1, 0, 0}), {0, 1, 0});
  ExpectNear(Rotate(AxisAngle({1, 0, 0}, kPi / 2), {0, 1, 0}), {0, 0, 1});
  ExpectNear(Rotate(AxisAngle({0, 1, 0}, kPi / 2), {0, 0, 1}), {1, 0, 0});
  // The right factor applies first.
  ExpectNear(Rotate(AxisAngle({0, 0, 1}, kPi / 2) * AxisAngle({1, 0, 0}, kPi / 2), {0, 1, 0}),
             {0, 0, 1});
}

TEST(Rotation, TakesTheShortestArcEvenBetweenOppositeDirections) {
  const Vec3d directions[] = {{1, 0, 0}, {0, -1, 0}, {0.6, 0, 0.8}, {-1, 0, 0}, {-1 + 1e-13, 0, 0}};
  for (const Vec3d& from : directions) {
    for (const Vec3d& to : directions) {
      const Vec3d axis = Unit(Cross(from, {0.1, 0.2, 0.3}), {0, 0, 1});
      const Quaternion q = ShortestArc(from, to, axis);
      test::ExpectNear(Rotate(q, from), to, 1e-8);
      EXPECT_NEAR(Angle(q, {}), std::acos(std::min(1.0, std::max(-1.0, Dot(from, to)))), 1e-6);
    }
  }
}

TEST(Rotation, FitsARotationExactly) {
  const Quaternion truth = AxisAngle(Unit({1, -2, 3}, {}), 2.8);
  std::vector<Correspondence> points;
  for (const Vec3d& p : {Vec3d{1, 0, 0}, Vec3d{0, 2, 0}, Vec3d{0.3, 0.1, 0.7}}) {
    points.push_back({p, Rotate(truth, p)});
  }
  EXPECT_LT(Angle(FitRotation(points, {}), truth), 1e-7);
}

TEST(Rotation, UsesThePriorWherePointsAreAmbiguous) {
  const Quaternion prior = AxisAngle({0, 1, 0}, 0.7);
  EXPECT_LT(Angle(FitRotation({}, {{prior, 1}}), prior), 1e-7);
  // One direction fixes two of three angles; the third is the prior's.
  EXPECT_LT(Angle(FitRotation({{{0, 1, 0}, {0, 1, 0}}}, {{prior, 0.01}}), prior), 1e-7);
  EXPECT_LT(Angle(FitRotation({}, {}), {}), 1e-7);
}

TEST(Rotation, SlerpsAlongTheShorterArcAtConstantSpeed) {
  const Quaternion a = AxisAngle({0, 1, 0}, 0.3);
  const Quaternion b = a * AxisAngle(Unit({1, 2, 3}, {}), 2);
  const Quaternion minus_b = {-b.w, -b.x, -b.y, -b.z};
  for (const double share : {0.0, 0.25, 0.5, 1.0}) {
    for (const Quaternion& end : {b, minus_b}) {
      EXPECT_NEAR(Angle(a, Slerp(a, end, share)), 2 * share, 1e-7);
      EXPECT_NEAR(Angle(b, Slerp(a, end, share)), 2 * (1 - share), 1e-7);
    }
  }
  EXPECT_NEAR(Angle(Slerp(a, a, 0.4), a), 0, 1e-7);
  const Quaternion little = a * AxisAngle({1, 0, 0}, 1e-4);
  EXPECT_NEAR(Angle(Slerp(a, little, 0.5), little), 5e-5, 1e-7);
}

}  // namespace
}  // namespace duet::retargeting
