#include "model/body/dance.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/support/status_matchers.h"

namespace duet::body {
namespace {

using test::IsOk;
using test::StatusIs;
using testing::HasSubstr;
using testing::SizeIs;

constexpr double kRate = 30;
constexpr double kPi = 3.14159265358979;

// Hips with two sides, two feet, two wrists.
motion::Skeleton Figure() {
  motion::Skeleton skeleton;
  skeleton.joint_names = {"hips",       "left_hip",   "right_hip",  "left_foot",
                          "right_foot", "left_wrist", "right_wrist"};
  skeleton.bones = {{0, 1}, {0, 2}, {1, 3}, {2, 4}, {0, 5}, {0, 6}};
  skeleton.hips = motion::JointPair{1, 2};
  skeleton.feet = motion::JointPair{3, 4};
  return skeleton;
}

// Stands at a place, turned by `yaw`; the left wrist is 0.5 m in front.
std::vector<motion::Vec3> Stand(motion::Vec3 at, double yaw) {
  std::vector<motion::Vec3> pose = {{0, 1, 0},   {-.1f, 1, 0}, {.1f, 1, 0},  {-.1f, 0, 0},
                                    {.1f, 0, 0}, {0, 1, -.5f}, {.1f, 1, .2f}};
  for (motion::Vec3& p : pose) p = at + RotateY(p, yaw);
  return pose;
}

template <typename PoseAt>
motion::Poses Animate(double seconds, PoseAt pose_at) {
  motion::Poses poses(0, 7);
  for (int t = 0; t < seconds * kRate; ++t) poses.Append(pose_at(t / kRate));
  return poses;
}

DanceJoints Joints() { return *FindDanceJoints(Figure()); }

motion::Poses Standing(double seconds, motion::Vec3 at, double yaw) {
  return Animate(seconds, [&](double) { return Stand(at, yaw); });
}

// Turns by `degrees` in the second from `begin`.
motion::Poses Turning(double seconds, double begin, double degrees) {
  return Animate(seconds, [&](double s) {
    return Stand({0, 0, 0}, degrees * kPi / 180 * std::clamp(s - begin, 0.0, 1.0));
  });
}

TEST(DanceTest, JointsOfAnotherSkeletonAreNamedInTheError) {
  EXPECT_THAT(FindDanceJoints(Figure()), IsOk());
  motion::Skeleton lacks = Figure();
  lacks.feet.reset();
  EXPECT_THAT(FindDanceJoints(lacks).status(),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("feet")));
  lacks = Figure();
  lacks.joint_names[5] = "paw";
  EXPECT_THAT(FindDanceJoints(lacks).status(),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("left_wrist")));
  lacks.joint_names[5] = "left_hand";
  lacks.joint_names[6] = "right_hand";
  EXPECT_THAT(FindDanceJoints(lacks), IsOk());
}

TEST(DanceTest, ATurnHasATimeAndAWay) {
  const motion::Poses partner = Standing(4, {0, 0, -1}, kPi);
  const auto turns = FindTurns(Joints(), Turning(4, 1, 360), partner, kRate);
  ASSERT_THAT(turns, SizeIs(1));
  EXPECT_NEAR(turns[0].middle(), 1.5, 0.1);
  EXPECT_NEAR(std::abs(turns[0].degrees), 360, 15);
  const auto back = FindTurns(Joints(), Turning(4, 1, -360), partner, kRate);
  ASSERT_THAT(back, SizeIs(1));
  EXPECT_LT(back[0].degrees * turns[0].degrees, 0);
  EXPECT_THAT(FindTurns(Joints(), Turning(4, 1, 200), partner, kRate), SizeIs(0));
}

TEST(DanceTest, WalkingAroundThePartnerIsNoTurn) {
  // Always faces the partner, who stands at the origin.
  const motion::Poses circling = Animate(4, [](double s) {
    const double yaw = s * kPi / 2;
    return Stand(motion::RotateY({0, 0, 1}, yaw), yaw);
  });
  EXPECT_THAT(FindTurns(Joints(), circling, Standing(4, {0, 0, 0}, 0), kRate), SizeIs(0));
}

TEST(DanceTest, TurnsMatchTheNearestOfTheSameWay) {
  const std::vector<Turn> captured = {{1, 2, 360}, {5, 6, 360}, {9, 10, -360}};
  const TurnMatch match =
      MatchTurns(captured, {{1.2, 2.2, 300}, {1.6, 2.6, 300}, {9, 10, 360}, {10, 11.2, -250}});
  EXPECT_EQ(match.matched, 2);
  EXPECT_NEAR(match.mean_delay, (0.2 + 1.1) / 2, 1e-9);
  EXPECT_TRUE(std::isnan(MatchTurns(captured, {}).mean_delay));
}

TEST(DanceTest, HandsAreHeldWhileWristsAreNear) {
  // Face to face, wrists 10 cm apart; in the second half a metre farther.
  const motion::Poses leader = Standing(4, {0, 0, 0}, 0);
  const motion::Poses follower = Animate(4, [](double s) {
    return Stand({0, 0, s < 2 ? -1.1f : -2.1f}, kPi);
  });
  const Holds holds = MeasureHolds(Joints(), leader, follower, kRate);
  EXPECT_NEAR(holds.share, 0.5, 0.01);
  EXPECT_NEAR(holds.mean_seconds, 2, 0.05);
  EXPECT_NEAR(holds.slip, 0, 1e-5);
  const Holds none = MeasureHolds(Joints(), leader, Standing(4, {0, 0, -3}, kPi), kRate);
  EXPECT_EQ(none.share, 0);
  EXPECT_TRUE(std::isnan(none.mean_seconds));
}

TEST(DanceTest, SlipIsTheSpeedOfWristsAgainstEachOther) {
  const motion::Poses follower = Animate(1, [](double s) {
    return Stand({static_cast<float>(0.1 * s), 0, -1.1f}, kPi);
  });
  EXPECT_NEAR(MeasureHolds(Joints(), Standing(1, {0, 0, 0}, 0), follower, kRate).slip, 0.1, 1e-3);
}

TEST(DanceTest, BothFeetOfOneWhoStandsOrWalksDoNotMoveTogether) {
  EXPECT_EQ(BothFeetMove(Joints(), Standing(2, {0, 0, 0}, 0), kRate), 0);
  const motion::Poses skating = Animate(2, [](double s) {
    return Stand({static_cast<float>(s), 0, 0}, 0);
  });
  EXPECT_GT(BothFeetMove(Joints(), skating, kRate), 0.9);
}

TEST(DanceTest, ErrorIsTheMeanDistanceOfJoints) {
  EXPECT_NEAR(MeanError(Standing(1, {0, 0, 0}, 0), Standing(1, {0, 0, 2}, 0)), 2, 1e-5);
}

}  // namespace
}  // namespace duet::body
