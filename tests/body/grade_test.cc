#include "model/body/grade.h"

#include "gmock/gmock.h"
#include "model/body/contact.h"
#include "tests/support/bodies.h"

namespace duet::body {
namespace {

using motion::Vec3;
using test::Changed;
using test::kFrames;
using test::kRate;
using test::Puppet;

const motion::Skeleton& Sbu() {
  static const auto& skeleton = *new motion::Skeleton(motion::SbuSkeleton());
  return skeleton;
}
const Body& SbuBody() {
  static const auto& body = *new Body(FindBody(Sbu()));
  return body;
}

Grade GradeOf(const motion::Poses& leader, const motion::Poses& follower) {
  PairMeter meter(Sbu(), SbuBody(), kRate);
  GradeSum sum;
  for (int t = 0; t < kFrames; ++t) sum.Add(meter.Add(leader[t], follower[t]));
  return sum.Get();
}

motion::Poses Away(float metres) {
  return Changed(Puppet(), [metres](int, Vec3 joint) { return joint + Vec3{0, 0, metres}; });
}

TEST(Grade, OfAPersonWhoStandsApartIsPerfect) {
  const Grade grade = GradeOf(Puppet(), Away(1));
  EXPECT_EQ(grade.twisted, 0);
  EXPECT_EQ(grade.skating, 0);
  EXPECT_EQ(grade.leader_skating, 0);
  EXPECT_EQ(grade.overlapping, 0);
  EXPECT_TRUE(grade.bad_runs.empty());
}

TEST(Grade, CountsFramesInWhichBothFeetMove) {
  const motion::Poses sliding = Changed(Away(1), [](int t, Vec3 joint) {
    return joint + Vec3{0.02f * static_cast<float>(t), 0, 0};
  });
  const Grade grade = GradeOf(Puppet(), sliding);
  // The first frame has no speed.
  EXPECT_DOUBLE_EQ(grade.skating, (kFrames - 1) / double{kFrames});
  EXPECT_EQ(grade.leader_skating, 0);
  EXPECT_DOUBLE_EQ(GradeOf(sliding, Puppet()).leader_skating, grade.skating);
}

TEST(Grade, AFootThatStandsIsNoSkating) {
  const motion::Poses kicking =
      Puppet([](double t, test::PuppetPose* pose) { pose->left_foot.target.z += t; });
  EXPECT_EQ(GradeOf(Away(2), kicking).skating, 0);
}

TEST(Grade, NamesTheFramesThatOverlap) {
  motion::Poses near = Away(1);
  for (const int t : {5, 6, 7, 20}) {
    for (int j = 0; j < 15; ++j) near.at(t, j) = Puppet().at(t, j) + Vec3{0.05f, 0, 0};
  }
  const Grade grade = GradeOf(Puppet(), near);
  EXPECT_DOUBLE_EQ(grade.overlapping, 4.0 / kFrames);
  ASSERT_EQ(grade.bad_runs.size(), 2u);
  EXPECT_EQ(grade.bad_runs[0].first, 5);
  EXPECT_EQ(grade.bad_runs[0].count, 3);
  EXPECT_EQ(grade.bad_runs[1].first, 20);
}

TEST(TwistDegrees, IsTheTurnOfTheShouldersAgainstTheHips) {
  for (const double degrees : {-120.0, -30.0, 0.0, 50.0, 170.0}) {
    motion::Poses poses = Puppet({}, 1);
    const Vec3 neck = Lerp(poses.at(0, 3), poses.at(0, 6), 0.5f);
    for (const int shoulder : {3, 6}) {
      poses.at(0, shoulder) =
          neck + RotateY(poses.at(0, shoulder) - neck, degrees * 0.017453292519943);
    }
    EXPECT_NEAR(TwistDegrees(Sbu(), SbuBody(), poses[0]), degrees, 2) << degrees;
  }
}

TEST(ReachTowards, IsOneForAStretchedArm) {
  motion::Poses poses = Puppet({}, 1);
  const Limb& arm = SbuBody().arms[0];
  const Vec3 root = poses.at(0, Sbu().root);
  const float length = Distance(poses.at(0, arm.upper), poses.at(0, arm.middle)) +
                       Distance(poses.at(0, arm.middle), poses.at(0, arm.end));
  EXPECT_LT(ReachTowards(arm, Sbu().root, poses[0], root + Vec3{0, 0, 1}), 0.3);
  poses.at(0, arm.end) = root + Vec3{0, 0.3f, length};
  const double stretched = ReachTowards(arm, Sbu().root, poses[0], root + Vec3{0, 0.5f, 2});
  EXPECT_GT(stretched, 0.5);
  EXPECT_LT(ReachTowards(arm, Sbu().root, poses[0], root - Vec3{0, 0, 2}), 0);
  EXPECT_EQ(ReachTowards(arm, Sbu().root, poses[0], root), 0);
}

}  // namespace
}  // namespace duet::body
