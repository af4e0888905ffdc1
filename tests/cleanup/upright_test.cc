#include "model/cleanup/upright.h"

#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

motion::Poses Upright(motion::Poses poses, int settled = 0,
                      const motion::Skeleton& skeleton = motion::SbuSkeleton()) {
  SetUpright(skeleton, body::FindBody(skeleton), {}, {kRate, settled}, &poses);
  return poses;
}

motion::Poses Leaning(double degrees) {
  return Changed(Puppet(), [&](int, Vec3 joint) { return LeanForwards(joint, degrees); });
}

TEST(SetUpright, ALastingLeanInAnyDirectionIsReduced) {
  for (const double degrees : {20.0, 60.0}) {
    for (const double yaw : {0.0, 1.0, 2.5, 4.0}) {
      const motion::Poses leaning =
          Changed(Leaning(degrees), [&](int, Vec3 joint) { return RotateY(joint, yaw); });
      const motion::Poses upright = Upright(leaning);
      for (int t = 0; t < kFrames; ++t) {
        EXPECT_LE(LeanDegrees(upright, t), 11.01) << degrees;
        EXPECT_GE(LeanDegrees(upright, t), 7.9) << degrees;
      }
      EXPECT_LT(LargestLengthChange(upright, leaning), 1e-5f);
      // Turned about the point between the feet.
      EXPECT_LT(Distance(Lerp(upright.at(9, 11), upright.at(9, 14), 0.5f),
                         Lerp(leaning.at(9, 11), leaning.at(9, 14), 0.5f)),
                1e-5f);
    }
  }
}

TEST(SetUpright, AnUprightBodyStays) {
  EXPECT_EQ(Upright(Puppet()), Puppet());
  EXPECT_EQ(Upright(Leaning(6)), Leaning(6));
}

TEST(SetUpright, AShortBowStays) {
  // Up to 30 degrees and back within 0.6 seconds.
  const motion::Poses bow = Changed(Puppet(), [](int t, Vec3 joint) {
    const double at = (t - 20) / (0.6 * kRate);
    return LeanForwards(joint, at > 0 && at < 1 ? 30 * std::sin(3.14159 * at) : 0);
  });
  EXPECT_GT(LeanDegrees(Upright(bow), 24), LeanDegrees(bow, 24) - 2);
}

TEST(SetUpright, SettledFramesStayAndTheRestFollowsSmoothly) {
  const motion::Poses leaning = Leaning(25);
  const motion::Poses upright = Upright(leaning, 10);
  for (int t = 0; t < 10; ++t) EXPECT_EQ(upright[t], leaning[t]);
  EXPECT_LT(LeanDegrees(upright, 16), 11.01);
  EXPECT_LT(LargestStep(upright), 0.1f);
}

motion::Poses Bent(double degrees) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  motion::Poses poses = Puppet();
  for (int t = 0; t < poses.frame_count(); ++t) {
    const Vec3 pivot =
        Lerp(poses.at(t, skeleton.hips->left), poses.at(t, skeleton.hips->right), 0.5f);
    for (int j = 0; j < poses.joint_count(); ++j) {
      if (j == 10 || j == 11 || j == 13 || j == 14) continue;  // knees and feet
      poses.at(t, j) =
          pivot + RotateAbout(poses.at(t, j) - pivot, {1, 0, 0}, degrees * 3.14159265 / 180);
    }
  }
  return poses;
}

double TrunkLeanDegrees(const motion::Poses& poses, int frame) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const int chest = *body::FindBody(skeleton).chest;
  const Vec3 trunk =
      LastingLean(*skeleton.hips, chest, poses, 0.1)[static_cast<std::size_t>(frame)];
  return std::acos(trunk.y) * 180 / 3.14159265;
}

TEST(SetTrunkUpright, ALastingBendIsReducedOverFixedFeet) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  for (const double degrees : {-70.0, 30.0, 100.0}) {
    const motion::Poses bent = Bent(degrees);
    motion::Poses upright = bent;
    SetTrunkUpright(skeleton, body::FindBody(skeleton), {}, {kRate, 0}, &upright);
    EXPECT_GT(TrunkLeanDegrees(bent, 20), 20) << degrees;
    EXPECT_LT(TrunkLeanDegrees(upright, 20), 11.1) << degrees;
    EXPECT_LT(LargestLengthChange(upright, bent), 1e-4f);
    for (const int foot : {skeleton.feet->left, skeleton.feet->right}) {
      EXPECT_LT(Distance(upright.at(20, foot), bent.at(20, foot)), 0.02f);
    }
  }
}

TEST(SetTrunkUpright, AnUprightTrunkAndSettledFramesStay) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  motion::Poses poses = Puppet();
  SetTrunkUpright(skeleton, body::FindBody(skeleton), {}, {kRate, 0}, &poses);
  EXPECT_EQ(poses, Puppet());
  poses = Bent(40);
  SetTrunkUpright(skeleton, body::FindBody(skeleton), {}, {kRate, 5}, &poses);
  for (int t = 0; t < 5; ++t) EXPECT_EQ(poses[t], Bent(40)[t]);
  EXPECT_NE(poses[20], Bent(40)[20]);
}

TEST(SetUpright, NeedsHipsAndFeet) {
  EXPECT_EQ(Upright(Leaning(30), 0, WithoutHips()), Leaning(30));
  EXPECT_EQ(Upright(Leaning(30), 0, WithoutFeet()), Leaning(30));
}

}  // namespace
}  // namespace duet::cleanup
