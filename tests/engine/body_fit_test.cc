#include "model/engine/body_fit.h"

#include "gmock/gmock.h"
#include "tests/cleanup/bodies.h"

namespace duet::engine {
namespace {

using authoring::PuppetPose;
using cleanup::kRate;
using cleanup::Puppet;
using testing::Each;
using testing::IsEmpty;
using testing::SizeIs;

motion::Poses Scaled(double size, double seconds = 1) {
  return cleanup::Changed(
      Puppet({}, static_cast<int>(seconds * kRate)),
      [size](int, motion::Vec3 joint) { return joint * static_cast<float>(size); });
}

// Pairs whose followers have these sizes; the leaders have 1.
std::vector<double> Ratios(const std::vector<double>& sizes) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  BodyFit fit(skeleton, kRate);
  for (const double size : sizes) fit.Add(Scaled(1), Scaled(size));
  return fit.BoneRatios();
}

TEST(BodyFit, FollowersWhoAreSmallerOrLargerHaveRatios) {
  EXPECT_THAT(Ratios({0.9, 0.88, 0.9}), SizeIs(motion::SbuSkeleton().bones.size()));
  EXPECT_THAT(Ratios({0.9, 0.88, 0.9}), Each(testing::DoubleNear(0.9, 1e-3)));
  EXPECT_THAT(Ratios({1.2}), Each(testing::DoubleNear(1.2, 1e-3)));
}

TEST(BodyFit, AnyTwoPeopleHaveNone) {
  EXPECT_THAT(Ratios({}), IsEmpty());
  EXPECT_THAT(Ratios({1, 1, 1}), IsEmpty());
  EXPECT_THAT(Ratios({0.9, 0.9, 0.9, 1.1, 1.1}), IsEmpty());
  EXPECT_THAT(Ratios({0.99}), IsEmpty());
}

// A follower who stands, except in `share` of the frames, in which it crouches.
double HipHeight(double seconds, double share) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  BodyFit fit(skeleton, kRate);
  const motion::Poses follower = Puppet(
      [&](double at, PuppetPose* pose) {
        if (at < share * seconds) pose->torso.y -= 0.3;
      },
      static_cast<int>(seconds * kRate));
  fit.Add(follower, follower);
  return fit.HipHeight();
}

TEST(BodyFit, FindsHowHighHipsAreMostOfTheTime) {
  const double standing = HipHeight(40, 0);
  EXPECT_GT(standing, 0.9);
  EXPECT_NEAR(HipHeight(40, 0.05), standing, 0.01);
  EXPECT_LT(HipHeight(40, 0.3), standing - 0.1);
}

TEST(BodyFit, PosturesNeedTimeAndLegs) {
  EXPECT_EQ(HipHeight(20, 0), 0);
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  BodyFit clips(skeleton, kRate);
  for (int i = 0; i < 20; ++i) clips.Add(Scaled(1, 3), Scaled(1, 3));
  EXPECT_EQ(clips.HipHeight(), 0);
  const motion::Skeleton without = cleanup::WithoutFeet();
  BodyFit fit(without, kRate);
  fit.Add(Scaled(1, 40), Scaled(1, 40));
  EXPECT_EQ(fit.HipHeight(), 0);
}

// `count` pairs of three seconds; in `lunging` of them the follower stands astride for two.
body::PoseSeconds LongestPoses(int count, int lunging) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  BodyFit fit(skeleton, kRate);
  for (int i = 0; i < count; ++i) {
    const motion::Poses follower = Puppet([&](double at, PuppetPose* pose) {
      if (i < lunging && at < 2) pose->right_foot.target = {-0.12, cleanup::kAnkle, -0.8};
    });
    fit.Add(cleanup::Moved(Puppet(), {0, 0, 1}), follower);
  }
  return fit.LongestPoses();
}

TEST(BodyFit, FindsHowLongPeopleKeepPoses) {
  EXPECT_EQ(LongestPoses(20, 0).astride, 0.5);
  EXPECT_EQ(LongestPoses(20, 10).astride, 2);
  EXPECT_EQ(LongestPoses(40, 1).astride, 0.5) << "one of many";
  EXPECT_EQ(LongestPoses(20, 10).held_out, 0.5);
  EXPECT_EQ(LongestPoses(5, 5).astride, 0) << "too little motion to know";
}

}  // namespace
}  // namespace duet::engine
