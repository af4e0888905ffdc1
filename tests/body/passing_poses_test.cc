#include "model/body/passing_poses.h"

#include "gtest/gtest.h"
#include "tests/support/bodies.h"

namespace duet::body {
namespace {

using motion::Vec3;
using test::kAnkle;
using test::Puppet;

const motion::Skeleton kSkeleton = motion::SbuSkeleton();
const Body kBody = FindBody(kSkeleton);
constexpr int kShoulder = 6, kElbow = 7, kHand = 8;

motion::Poses Partner() { return test::Moved(Puppet(), {0, 0, 3}); }

// A standing person whose right arm is stretched out in a direction.
motion::Poses ArmOut(Vec3 direction) {
  motion::Poses poses = Puppet();
  for (int t = 0; t < poses.frame_count(); ++t) {
    poses.at(t, kElbow) = poses.at(t, kShoulder) + direction * 0.3f;
    poses.at(t, kHand) = poses.at(t, kShoulder) + direction * 0.55f;
  }
  return poses;
}

bool HeldOut(const motion::Poses& poses, const motion::Poses& partner = Partner()) {
  return IsHeldOut(kBody, kBody.arms[1], kSkeleton.root, partner[0], poses[0]);
}

TEST(IsAstride, IsAWideStepInAnyDirection) {
  EXPECT_FALSE(IsAstride(kBody, Puppet()[0]));
  const auto stepped = [](double x, double z) {
    const motion::Poses poses = Puppet([&](double, authoring::PuppetPose* pose) {
      pose->right_foot.target = {x, kAnkle, z};
    });
    return IsAstride(kBody, poses[0]);
  };
  EXPECT_TRUE(stepped(-0.12, -0.8));
  EXPECT_TRUE(stepped(-0.9, 0));
  EXPECT_FALSE(stepped(-0.12, -0.35));
}

TEST(IsHeldOut, IsAHandThatNeitherHangsNorReaches) {
  ASSERT_EQ(kBody.arms[1].end, kHand);
  EXPECT_TRUE(HeldOut(ArmOut({-1, 0, 0})));
  EXPECT_TRUE(HeldOut(ArmOut({0, 1, 0})));
  EXPECT_FALSE(HeldOut(ArmOut({0, -1, 0}))) << "hangs";
  EXPECT_FALSE(HeldOut(ArmOut({0, 0, 1}))) << "reaches for the partner";
  EXPECT_TRUE(HeldOut(ArmOut({0, 0, 1}), test::Moved(Puppet(), {0, 0, -3})));
}

TEST(IsHeldOut, IsNotAHandThatThePartnerHolds) {
  motion::Poses partner = Partner();
  const motion::Poses out = ArmOut({-1, 0, 0});
  partner.at(0, kHand) = out.at(0, kHand) + Vec3{0, 0.3f, 0};
  EXPECT_FALSE(HeldOut(out, partner));
}

TEST(LongestPosesTest, CountsTheLongestTimeOfEach) {
  const motion::Poses out = ArmOut({-1, 0, 0}), stands = Puppet(), partner = Partner();
  LongestPoses longest(kSkeleton, kBody);
  for (const int frames : {3, 7, 2}) {
    for (int t = 0; t < frames; ++t) longest.Add(partner[t], out[t]);
    longest.Add(partner[0], stands[0]);
  }
  EXPECT_EQ(longest.Get(10).held_out, 0.7);
  EXPECT_EQ(longest.Get(10).astride, 0);
}

}  // namespace
}  // namespace duet::body
