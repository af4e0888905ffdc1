#include "model/cleanup/waist.h"

#include "model/body/grade.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr int kLeftHip = 9, kRightHip = 12, kTorso = 2;

// The puppet with its hips turned about the vertical by `degrees` and `narrow` times as wide.
motion::Poses WithHips(double degrees, float narrow = 1) {
  motion::Poses poses = Puppet();
  for (int t = 0; t < poses.frame_count(); ++t) {
    const Vec3 middle = Lerp(poses.at(t, kLeftHip), poses.at(t, kRightHip), 0.5f);
    for (const int hip : {kLeftHip, kRightHip}) {
      poses.at(t, hip) =
          middle + RotateY(poses.at(t, hip) - middle, degrees * 0.017453292519943) * narrow;
    }
  }
  return poses;
}

motion::Poses Limited(motion::Poses poses, int settled = 0,
                      const motion::Skeleton& skeleton = motion::SbuSkeleton()) {
  LimitWaist(skeleton, body::FindBody(skeleton), Puppet(), {}, {kRate, settled}, &poses);
  return poses;
}

double Twist(const motion::Poses& poses, int frame = kFrames - 1) {
  return body::TwistDegrees(motion::SbuSkeleton(), body::FindBody(motion::SbuSkeleton()),
                            poses[frame]);
}

TEST(LimitWaist, LeavesAPersonAlone) {
  EXPECT_EQ(Limited(Puppet()), Puppet());
  EXPECT_EQ(Limited(WithHips(28)), WithHips(28));
  EXPECT_EQ(Limited(WithHips(-28, 0.9f)), WithHips(-28, 0.9f));
}

TEST(LimitWaist, TurnsHipsToTheRangeOfAWaist) {
  for (const double degrees : {-170.0, -100.0, -60.0, 60.0, 89.0, 91.0, 150.0, 180.0}) {
    EXPECT_LT(std::abs(Twist(Limited(WithHips(degrees)))), 45.01) << degrees;
  }
  EXPECT_GT(std::abs(Twist(WithHips(60))), 59);
}

TEST(LimitWaist, KeepsTheSideOfATurn) {
  EXPECT_GT(Twist(WithHips(-60)), 0);
  EXPECT_GT(Twist(Limited(WithHips(-60))), 30);
  EXPECT_LT(Twist(Limited(WithHips(60))), -30);
}

TEST(LimitWaist, WidensHipsThatShrankToAPoint) {
  const motion::Poses limited = Limited(WithHips(0, 0.05f));
  const float width = Distance(Puppet().at(0, kLeftHip), Puppet().at(0, kRightHip));
  EXPECT_GT(Distance(limited.at(9, kLeftHip), limited.at(9, kRightHip)), 0.8f * width);
}

TEST(LimitWaist, KeepsBonesAndFeet) {
  const motion::Poses turned = WithHips(120), limited = Limited(turned);
  for (const int hip : {kLeftHip, kRightHip}) {
    EXPECT_NEAR(Distance(limited.at(5, hip), limited.at(5, kTorso)),
                Distance(turned.at(5, hip), turned.at(5, kTorso)), 1e-4f);
  }
  for (const int foot : {11, 14}) {
    EXPECT_LT(Distance(limited.at(5, foot), turned.at(5, foot)), 0.03f);
  }
}

// Hips that turn at a constant speed move without jumps, also through 90 and 180 degrees.
TEST(LimitWaist, IsContinuous) {
  motion::Poses before = Limited(WithHips(0));
  for (int degrees = 1; degrees <= 360; ++degrees) {
    const motion::Poses now = Limited(WithHips(degrees));
    EXPECT_LT(Distance(before.at(3, kLeftHip), now.at(3, kLeftHip)), 0.02f) << degrees;
    before = now;
  }
}

TEST(LimitWaist, LeavesSettledFramesAndEasesIn) {
  const motion::Poses turned = WithHips(100), limited = Limited(turned, 10);
  for (int t = 0; t < 10; ++t) EXPECT_EQ(limited[t], turned[t]);
  EXPECT_GT(std::abs(Twist(limited, 10)), 60);
  EXPECT_LT(std::abs(Twist(limited)), 45.01);
}

TEST(LimitWaist, NeedsHipsAndShoulders) {
  EXPECT_EQ(Limited(WithHips(100), 0, WithoutHips()), WithHips(100));
  motion::Skeleton unnamed = motion::SbuSkeleton();
  for (std::string& name : unnamed.joint_names)
    name = "j" + name.substr(name.find('_') + 1) + name.substr(0, 1);
  EXPECT_EQ(Limited(WithHips(100), 0, unnamed), WithHips(100));
}

}  // namespace
}  // namespace duet::cleanup
