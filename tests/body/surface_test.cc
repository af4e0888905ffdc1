#include "model/body/surface.h"

#include "gtest/gtest.h"
#include "tests/support/bodies.h"

namespace duet::body {
namespace {

using motion::Vec3;

constexpr int kTorso = 2, kNeck = 1, kRightElbow = 7, kRightHand = 8;

double FromSurface(Vec3 point, const motion::Poses& poses) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  return Surface(skeleton, FindBody(skeleton)).Distance(point, poses[0]);
}

TEST(Surface, IsNegativeInsideAndGrowsWithTheWay) {
  const motion::Poses person = test::Puppet();
  const Vec3 trunk = Lerp(person.at(0, kTorso), person.at(0, kNeck), 0.5f);
  EXPECT_LT(FromSurface(trunk, person), -0.1);
  EXPECT_NEAR(FromSurface(trunk + Vec3{0, 0, 0.5f}, person), 0.39, 0.02);
  EXPECT_NEAR(FromSurface(trunk + Vec3{0, 0, 0.8f}, person), 0.69, 0.02);
}

TEST(Surface, HasNoArms) {
  motion::Poses person = test::Puppet();
  const Vec3 ahead = person.at(0, kTorso) + Vec3{0, 0, 0.7f};
  const double before = FromSurface(ahead, person);
  person.at(0, kRightElbow) = person.at(0, kRightHand) = ahead;
  EXPECT_EQ(FromSurface(ahead, person), before);
}

}  // namespace
}  // namespace duet::body
