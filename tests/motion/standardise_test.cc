#include "model/motion/standardise.h"

#include <cmath>

#include "gtest/gtest.h"
#include "tests/support/sample_motion.h"

namespace duet::motion {
namespace {

using test::SwayingMotion;

constexpr int kJoints = 15, kTorso = 2, kLeftHip = 9, kRightHip = 12;

// A leader who walks, turned by `yaw` and far from the origin.
Poses Leader(double yaw) {
  Poses leader = SwayingMotion(20, 15);
  for (Vec3& p : leader.all()) p = RotateY(p, yaw) + Vec3{3, 0, -4};
  return leader;
}

Poses Follower() {
  Poses follower = SwayingMotion(20, 15);
  for (Vec3& p : follower.all()) p = RotateY(p, 2.5) + Vec3{2, 0.1f, -5};
  return follower;
}

void ExpectNear(const Poses& got, const Poses& wanted, float tolerance) {
  ASSERT_EQ(got.joint_count(), wanted.joint_count());
  ASSERT_EQ(got.frame_count(), wanted.frame_count());
  for (std::size_t i = 0; i < got.all().size(); ++i) {
    ASSERT_LE(Distance(got.all()[i], wanted.all()[i]), tolerance) << "frame " << i / kJoints;
  }
}

class AnyYaw : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Standardisation, AnyYaw,
                         ::testing::Values(0, 0.5, 1.5707963, 2, 3.1415926, 4, 5, 6));

TEST_P(AnyYaw, PutsTheLeadersRootAtTheOriginOfEveryFrame) {
  const Poses leader = Leader(GetParam());
  const Poses standard = Standardisation(SbuSkeleton(), leader).Apply(leader);
  for (int t = 0; t < standard.frame_count(); ++t) {
    EXPECT_EQ(standard.at(t, kTorso), (Vec3{0, 0, 0})) << "frame " << t;
  }
}

TEST_P(AnyYaw, PutsTheFirstFramesHipsOnPlusX) {
  const Poses leader = Leader(GetParam());
  const Poses standard = Standardisation(SbuSkeleton(), leader).Apply(leader);
  const Vec3 across = standard.at(0, kRightHip) - standard.at(0, kLeftHip);
  EXPECT_GT(across.x, 0.1f);
  EXPECT_NEAR(across.z, 0, 1e-6);
}

TEST_P(AnyYaw, InvertsExactly) {
  const Poses leader = Leader(GetParam()), follower = Follower();
  for (YawDirection direction : {YawDirection::kRemove, YawDirection::kAsReleasedCode}) {
    const Standardisation standardisation(SbuSkeleton(), leader, direction);
    ExpectNear(standardisation.Invert(standardisation.Apply(leader)), leader, 1e-5f);
    ExpectNear(standardisation.Invert(standardisation.Apply(follower)), follower, 1e-5f);
  }
}

TEST_P(AnyYaw, FirstFrameOriginKeepsStillJointsStill) {
  Poses leader = Leader(GetParam());
  for (int t = 0; t < leader.frame_count(); ++t) {
    for (Vec3& p : leader[t]) p.x += 0.02f * static_cast<float>(t);  // walks
  }
  const Standardisation frame(SbuSkeleton(), leader, YawDirection::kRemove,
                              StandardOrigin::kFirstFrame);
  const Poses standard = frame.Apply(leader);
  EXPECT_EQ(standard.at(0, kTorso), (Vec3{0, 0, 0}));
  const int last = standard.frame_count() - 1;
  EXPECT_NEAR(Norm(standard.at(last, kTorso)),
              Distance(leader.at(last, kTorso), leader.at(0, kTorso)), 1e-5);
  const Vec3 place{5, 1, 2};
  const Poses still(kJoints, std::vector<Vec3>(leader.all().size(), place));
  const Poses standing = frame.Apply(still);
  for (const Vec3& point : standing.all()) EXPECT_EQ(point, frame.Apply(place));
  ExpectNear(frame.Invert(standard), leader, 1e-5f);
}

TEST(Standardisation, CoincidentHipsDoNotChangeTheYaw) {
  Poses leader = Leader(1);
  leader.at(0, kRightHip).x = leader.at(0, kLeftHip).x;
  leader.at(0, kRightHip).z = leader.at(0, kLeftHip).z;
  for (YawDirection direction : {YawDirection::kRemove, YawDirection::kAsReleasedCode}) {
    EXPECT_EQ(Standardisation(SbuSkeleton(), leader, direction).yaw(), 0);
  }
}

TEST(Standardisation, WithoutHipsOnlyTheCallersYawApplies) {
  const Poses leader = Leader(1);
  Skeleton skeleton = SbuSkeleton();
  skeleton.hips.reset();
  for (YawDirection direction : {YawDirection::kRemove, YawDirection::kAsReleasedCode}) {
    EXPECT_EQ(Standardisation(skeleton, leader, direction).yaw(), 0);
  }
  EXPECT_EQ(Standardisation(skeleton, leader, 0.5).yaw(), 0.5);
  ExpectNear(Standardisation(skeleton, leader).Apply(leader),
             Standardisation(SbuSkeleton(), leader, 0.0).Apply(leader), 0);
}

TEST(FacingYaw, TurnsADirectionToMinusZ) {
  for (const Vec3 direction : {Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{-3, 0, 4}}) {
    const Vec3 turned = RotateY(direction, FacingYaw(direction));
    EXPECT_LT(Distance(turned / Norm(turned), {0, 0, -1}), 1e-6f);
  }
}

TEST(Standardisation, ReleasedCodeTurnsTheWrongWay) {
  // Hips at 101.31 degrees in x-z. The published code turns by the arc tangent of -5, -78.69.
  Poses leader(1, kJoints);
  leader.at(0, kRightHip) = {-0.2f, 0, 1};
  const Vec3 turned = Standardisation(SbuSkeleton(), leader, YawDirection::kAsReleasedCode)
                          .Apply(leader)
                          .at(0, kRightHip);
  EXPECT_NEAR(std::atan2(turned.z, turned.x) * 180 / M_PI, 101.31 - 78.69, 0.01);
}

}  // namespace
}  // namespace duet::motion
