#include "model/engine/facing_fit.h"

#include "gtest/gtest.h"
#include "model/base/angle.h"
#include "tests/support/bodies.h"

namespace duet::engine {
namespace {

using motion::Vec3;
using test::kFrames;
using test::kRate;

// Adds 12 seconds of a follower who is turned away by `degrees` from a leader in front of it.
void AddTurned(double degrees, FacingFit* fit) {
  const motion::Poses leader = test::Moved(test::Puppet(), {0, 0, 1});
  const motion::Poses follower = test::Changed(test::Puppet(), [&](int, Vec3 joint) {
    return RotateY(joint, degrees * base::kRadiansPerDegree);
  });
  for (int n = 0; n < 4; ++n) fit->Add(leader, follower, 0, kFrames);
}

TEST(FacingFit, FindsHowFarFollowersAreTurnedAway) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  FacingFit fit(skeleton, kRate);
  for (int n = 0; n < 8; ++n) AddTurned(-10, &fit);
  AddTurned(40, &fit);
  AddTurned(60, &fit);
  ASSERT_TRUE(fit.Degrees().has_value());
  EXPECT_NEAR(*fit.Degrees(), 40, 5);
}

TEST(FacingFit, PeopleSideBySideDoNotFaceEachOther) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  FacingFit fit(skeleton, kRate);
  AddTurned(90, &fit);
  EXPECT_FALSE(fit.Degrees().has_value());
}

TEST(FacingFit, AFewFramesShowNothing) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  FacingFit fit(skeleton, kRate);
  EXPECT_FALSE(fit.Degrees().has_value());
  fit.Add(test::Moved(test::Puppet(), {0, 0, 1}), test::Puppet(), 0, kFrames - 2);
  EXPECT_FALSE(fit.Degrees().has_value());
}

TEST(FacingFit, OnlyTheFramesOfTheStretchCount) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  FacingFit fit(skeleton, kRate);
  const motion::Poses leader = test::Moved(test::Puppet(), {0, 0, 1});
  const motion::Poses turned = test::Changed(
      test::Puppet(), [](int t, Vec3 joint) { return t < 20 ? joint : RotateY(joint, 3); });
  for (int n = 0; n < 8; ++n) fit.Add(leader, turned, 0, 20);
  ASSERT_TRUE(fit.Degrees().has_value());
  EXPECT_NEAR(*fit.Degrees(), 0, 0.5);
}

}  // namespace
}  // namespace duet::engine
