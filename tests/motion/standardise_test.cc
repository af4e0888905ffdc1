#include "model/motion/standardise.h"

#include <cmath>

#include "gtest/gtest.h"
#include "tests/support/sample_motion.h"

namespace duet::motion {
namespace {

using test::SwayingMotion;

constexpr std::size_t kJoints = 15, kTorso = 2, kLeftHip = 9, kRightHip = 12;

// A leader who walks, turned by `yaw` and far from the origin.
std::vector<Vec3> Leader(double yaw) {
  std::vector<Vec3> leader = SwayingMotion(20, 15);
  for (Vec3& p : leader) p = RotateY(p, yaw) + Vec3{3, 0, -4};
  return leader;
}

std::vector<Vec3> Follower() {
  std::vector<Vec3> follower = SwayingMotion(20, 15);
  for (Vec3& p : follower) p = RotateY(p, 2.5) + Vec3{2, 0.1f, -5};
  return follower;
}

void ExpectNear(const std::vector<Vec3>& got, const std::vector<Vec3>& wanted, float tolerance) {
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    ASSERT_LE(Distance(got[i], wanted[i]), tolerance) << "frame " << i / kJoints;
  }
}

class AnyYaw : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Standardisation, AnyYaw,
                         ::testing::Values(0, 0.5, 1.5707963, 2, 3.1415926, 4, 5, 6));

TEST_P(AnyYaw, PutsTheLeadersRootAtTheOriginOfEveryFrame) {
  const std::vector<Vec3> leader = Leader(GetParam());
  const std::vector<Vec3> standard = Standardisation(SbuSkeleton(), leader).Apply(leader);
  for (std::size_t i = kTorso; i < standard.size(); i += kJoints) {
    EXPECT_EQ(standard[i], (Vec3{0, 0, 0})) << "frame " << i / kJoints;
  }
}

TEST_P(AnyYaw, PutsTheFirstFramesHipsOnPlusX) {
  const std::vector<Vec3> leader = Leader(GetParam());
  const std::vector<Vec3> standard = Standardisation(SbuSkeleton(), leader).Apply(leader);
  const Vec3 across = standard[kRightHip] - standard[kLeftHip];
  EXPECT_GT(across.x, 0.1f);
  EXPECT_NEAR(across.z, 0, 1e-6);
}

TEST_P(AnyYaw, DoesNotDependOnWhereTheLeaderStands) {
  const std::vector<Vec3> here = Leader(0), there = Leader(GetParam());
  ExpectNear(Standardisation(SbuSkeleton(), there).Apply(there),
             Standardisation(SbuSkeleton(), here).Apply(here), 1e-5f);
}

TEST_P(AnyYaw, InvertsExactly) {
  const std::vector<Vec3> leader = Leader(GetParam()), follower = Follower();
  for (YawDirection direction : {YawDirection::kRemove, YawDirection::kAsReleasedCode}) {
    const Standardisation standardisation(SbuSkeleton(), leader, direction);
    ExpectNear(standardisation.Invert(standardisation.Apply(leader)), leader, 1e-5f);
    ExpectNear(standardisation.Invert(standardisation.Apply(follower)), follower, 1e-5f);
  }
}

TEST_P(AnyYaw, KeepsTheDistanceBetweenTheTwo) {
  const std::vector<Vec3> leader = Leader(GetParam()), follower = Follower();
  const Standardisation standardisation(SbuSkeleton(), leader);
  const std::vector<Vec3> a = standardisation.Apply(leader), b = standardisation.Apply(follower);
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_NEAR(Distance(a[i], b[i]), Distance(leader[i], follower[i]), 1e-5f);
  }
}

TEST_P(AnyYaw, FirstFrameOriginLeavesWhatStandsStillStill) {
  std::vector<Vec3> leader = Leader(GetParam());
  for (std::size_t i = 0; i < leader.size(); ++i) {
    leader[i].x += 0.02f * static_cast<float>(i / kJoints);  // walks
  }
  const Standardisation frame(SbuSkeleton(), leader, YawDirection::kRemove,
                              StandardOrigin::kFirstFrame);
  const std::vector<Vec3> standard = frame.Apply(leader);
  EXPECT_EQ(standard[kTorso], (Vec3{0, 0, 0}));
  const std::size_t last = standard.size() - kJoints;
  EXPECT_NEAR(Norm(standard[last + kTorso]), Distance(leader[last + kTorso], leader[kTorso]), 1e-5);
  const std::vector<Vec3> still(leader.size(), Vec3{5, 1, 2});
  for (const Vec3& point : frame.Apply(still)) EXPECT_EQ(point, frame.Apply(still.front()));
  ExpectNear(frame.Invert(standard), leader, 1e-5f);
}

TEST(Standardisation, OneYawServesAllFrames) {
  // The hips turn during the clip; only the first frame's are brought to +x.
  const std::vector<Vec3> leader = Leader(0);
  const std::vector<Vec3> standard = Standardisation(SbuSkeleton(), leader).Apply(leader);
  const std::size_t last = 19 * kJoints;
  EXPECT_GT(std::abs(standard[last + kRightHip].z - standard[last + kLeftHip].z), 0.01f);
}

TEST(Standardisation, PlacesARunOfFramesWithinTheClip) {
  const std::vector<Vec3> leader = Leader(1);
  const Standardisation standardisation(SbuSkeleton(), leader);
  const std::vector<Vec3> whole = standardisation.Apply(leader);
  const auto from = [](const std::vector<Vec3>& v) {
    return std::vector<Vec3>(v.begin() + 5 * kJoints, v.begin() + 8 * kJoints);
  };
  EXPECT_EQ(standardisation.Apply(from(leader), 5), from(whole));
  ExpectNear(standardisation.Invert(from(whole), 5), from(leader), 1e-5f);
}

TEST(Standardisation, PointsAreThoseOfTheFirstFrame) {
  const std::vector<Vec3> leader = Leader(1);
  const Standardisation standardisation(SbuSkeleton(), leader);
  EXPECT_EQ(standardisation.Apply(leader[7]), standardisation.Apply(leader)[7]);
}

TEST(Standardisation, HipsOnOneSpotLeaveTheYawAlone) {
  std::vector<Vec3> leader = Leader(1);
  leader[kRightHip].x = leader[kLeftHip].x;
  leader[kRightHip].z = leader[kLeftHip].z;
  for (YawDirection direction : {YawDirection::kRemove, YawDirection::kAsReleasedCode}) {
    EXPECT_EQ(Standardisation(SbuSkeleton(), leader, direction).yaw(), 0);
  }
}

TEST(Standardisation, TakesAYawOfTheCallersChoice) {
  const std::vector<Vec3> leader = Leader(1);
  const Standardisation standardisation(SbuSkeleton(), leader, M_PI / 2);
  EXPECT_LT(Distance(standardisation.Apply(leader[kTorso] + Vec3{0, 0, 1}), {1, 0, 0}), 1e-5f);
}

TEST(FacingYaw, TurnsADirectionToMinusZ) {
  for (const Vec3 direction : {Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{-3, 0, 4}}) {
    const Vec3 turned = RotateY(direction, FacingYaw(direction));
    EXPECT_LT(Distance(turned / Norm(turned), {0, 0, -1}), 1e-6f);
  }
}

TEST(Standardisation, ReleasedCodeTurnsTheWrongWay) {
  // Hips at 101.31 degrees in x-z. The published code turns by the arc tangent of -5, -78.69.
  std::vector<Vec3> leader(kJoints);
  leader[kRightHip] = {-0.2f, 0, 1};
  const Vec3 turned = Standardisation(SbuSkeleton(), leader, YawDirection::kAsReleasedCode)
                          .Apply(leader)[kRightHip];
  EXPECT_NEAR(std::atan2(turned.z, turned.x) * 180 / M_PI, 101.31 - 78.69, 0.01);
}

}  // namespace
}  // namespace duet::motion
