#include "model/cleanup/steps_in_time.h"

#include <cmath>

#include "gmock/gmock.h"
#include "model/motion/steps.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using authoring::PuppetPose;
using motion::Vec3;

constexpr int kLong = 90;
constexpr double kPeriod = 2.4, kSwing = 0.3;  // seconds, of the steps of each foot

// Where a foot is that steps to and fro, one step in every period from `begin` on.
double FootAt(double seconds, double begin) {
  const double steps = std::floor((seconds - begin) / kPeriod);
  const double swing = std::min(1.0, (seconds - begin - steps * kPeriod) / kSwing);
  const double share = swing * swing * (3 - 2 * swing);
  return 0.3 * (static_cast<int>(steps) % 2 == 0 ? share : 1 - share);
}

// Steps with each foot in turn, `late` seconds later than one who begins at 0.
motion::Poses Stepping(double late) {
  return Puppet(
      [late](double seconds, PuppetPose* pose) {
        pose->left_foot.target.z = FootAt(seconds, late);
        pose->right_foot.target.z = FootAt(seconds, late + kPeriod / 2);
      },
      kLong);
}

const motion::JointPair& Feet() {
  static const motion::Skeleton skeleton = motion::SbuSkeleton();
  return *skeleton.feet;
}

// Mean distance in time of the follower's steps from the leader's, within [from, to) seconds.
double Late(const motion::Poses& leader, const motion::Poses& follower, double from, double to) {
  const std::vector<double> leaders = FindSteps(Feet(), leader, kRate);
  std::vector<double> steps;
  for (const double step : FindSteps(Feet(), follower, kRate)) {
    if (from <= step && step < to) steps.push_back(step);
  }
  return motion::MeasureStepTiming(steps, leaders).mean_distance;
}

motion::Poses InTime(const motion::Poses& leader, motion::Poses follower, int settled = 0) {
  StepInTime(Feet(), leader, {kRate, settled}, &follower);
  return follower;
}

TEST(StepInTime, StepsThatAreLateFallOnThoseOfTheLeader) {
  const motion::Poses leader = Stepping(0);
  for (const double late : {0.2, -0.2}) {
    EXPECT_GT(Late(leader, Stepping(late), 1, 5), 0.15) << late;
    EXPECT_LT(Late(leader, InTime(leader, Stepping(late)), 1, 5), 0.14) << late;
  }
}

TEST(StepInTime, OneInTimeIsHardlyChanged) {
  EXPECT_LT(LargestDistance(Stepping(0), InTime(Stepping(0), Stepping(0))), 1e-4f);
}

TEST(StepInTime, WithoutStepsNothingChanges) {
  EXPECT_EQ(InTime(Puppet({}, kLong), Stepping(0.2)), Stepping(0.2));
  EXPECT_EQ(InTime(Stepping(0), Puppet({}, kLong)), Puppet({}, kLong));
}

TEST(StepInTime, SettledFramesAndTheLastDoNotChange) {
  constexpr int kSettled = 30;
  const motion::Poses before = Stepping(0.2), after = InTime(Stepping(0), before, kSettled);
  for (int t = 0; t < kSettled; ++t) {
    for (int j = 0; j < before.joint_count(); ++j) ASSERT_EQ(after.at(t, j), before.at(t, j)) << t;
  }
  for (int j = 0; j < before.joint_count(); ++j) {
    EXPECT_EQ(after.at(kLong - 1, j), before.at(kLong - 1, j));
  }
  EXPECT_LT(Late(Stepping(0), after, 3, 5), 0.14);
  // The motion goes on without a jump, and no faster than the follower's own by more than a third.
  EXPECT_LT(LargestStep(after), 1.6f * LargestStep(before));
}

TEST(StepInTime, AStepFarFromAllOfTheLeadersKeepsItsTime) {
  const auto one = [](double at) {
    return Puppet(
        [at](double seconds, PuppetPose* pose) {
          pose->left_foot.target.z = seconds < at ? 0 : FootAt(std::min(seconds, at + 1), at);
        },
        kLong);
  };
  ASSERT_EQ(FindSteps(Feet(), one(2), kRate).size(), 1u);
  EXPECT_EQ(InTime(one(2), one(2.5)), one(2.5));
  EXPECT_NE(InTime(one(2), one(2.2)), one(2.2));
}

}  // namespace
}  // namespace duet::cleanup
