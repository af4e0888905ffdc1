#include "model/solver/trunk.h"

#include <cmath>

#include "gtest/gtest.h"
#include "model/base/angle.h"
#include "tests/support/bodies.h"

namespace duet::solver {
namespace {

using motion::Vec3;
using test::kFrames;
using test::kRate;

constexpr int kNeck = 1, kHead = 0, kLeftHip = 9, kRightHip = 12, kLeftFoot = 11;

struct Fixture {
  motion::Skeleton skeleton = motion::SbuSkeleton();
  body::Body body = body::FindBody(skeleton);
  Trunk trunk{skeleton, body};
};

// The angle of the hips against the shoulders about the vertical, degrees.
double Twist(const motion::Poses& poses, int t) {
  const auto yaw = [&](int left, int right) {
    const Vec3 line = poses.at(t, left) - poses.at(t, right);
    return std::atan2(line.z, line.x) * base::kDegreesPerRadian;
  };
  return std::abs(std::remainder(yaw(3, 6) - yaw(kLeftHip, kRightHip), 360));
}

motion::Poses Twisted(double degrees) {
  motion::Poses poses = test::Puppet();
  for (int t = 0; t < kFrames; ++t) {
    for (int joint = kLeftHip; joint < 15; ++joint) {
      poses.at(t, joint) = RotateY(poses.at(t, joint), degrees * base::kRadiansPerDegree);
    }
  }
  return poses;
}

TEST(TrunkTest, LimitsTheTwistAndKeepsASmallOne) {
  const Fixture f;
  for (const double degrees : {70.0, -70.0, 170.0}) {
    motion::Poses poses = Twisted(degrees);
    f.trunk.LimitTwist(kRate, 0, &poses);
    EXPECT_LT(Twist(poses, 20), 46) << degrees;
  }
  motion::Poses small = Twisted(25);
  f.trunk.LimitTwist(kRate, 0, &small);
  EXPECT_NEAR(Twist(small, 20), 25, 1);
}

TEST(TrunkTest, LimitsHowFarTheHeadIsBent) {
  const Fixture f;
  motion::Poses poses = test::Puppet();
  for (int t = 0; t < kFrames; ++t) {
    poses.at(t, kHead) = poses.at(t, kNeck) + Vec3{0, -0.1f, 0.15f};
  }
  f.trunk.LimitTwist(kRate, 0, &poses);
  EXPECT_GT(poses.at(20, kHead).y, poses.at(20, kNeck).y);
}

TEST(TrunkTest, EndsALastingLeanOnItsFeetAndKeepsAShortOne) {
  const Fixture f;
  const auto leaning = [](int from, int to) {
    return test::Changed(test::Puppet(), [=](int t, Vec3 joint) {
      return t >= from && t < to ? test::LeanForwards(joint, 30) : joint;
    });
  };
  const motion::Poses before = leaning(0, kFrames);
  motion::Poses lasting = before, passing = leaning(20, 24);
  f.trunk.LimitLean(kRate, 0, 0, &lasting);
  f.trunk.LimitLean(kRate, 0, 0, &passing);
  EXPECT_LT(f.trunk.LeanDegrees(lasting, 20), 18);
  EXPECT_LT(Distance(lasting.at(20, kLeftFoot), before.at(20, kLeftFoot)), 0.01f);
  EXPECT_GT(f.trunk.LeanDegrees(passing, 22), 25);
  motion::Poses own = before;
  f.trunk.LimitLean(kRate, 0, 35, &own);
  EXPECT_GT(f.trunk.LeanDegrees(own, 20), 27) << "as far as this person may";
}

TEST(TrunkTest, LeavesTheGivenFramesAndNothingJumpsAfterThem) {
  const Fixture f;
  const motion::Poses before = Twisted(80);
  motion::Poses poses = before;
  f.trunk.LimitTwist(kRate, 10, &poses);
  f.trunk.LimitLean(kRate, 10, 0, &poses);
  for (int t = 0; t < 10; ++t) EXPECT_EQ(poses[t], before[t]) << t;
  EXPECT_LT(test::LargestStep(poses), 0.06f);
  EXPECT_LT(Twist(poses, 40), 46);
}

}  // namespace
}  // namespace duet::solver
