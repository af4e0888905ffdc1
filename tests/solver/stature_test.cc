#include "model/solver/stature.h"

#include "gtest/gtest.h"
#include "tests/solver/noisy_person.h"
#include "tests/support/bodies.h"

namespace duet::solver {
namespace {

using motion::Vec3;
using test::kFrames;
using test::Puppet;

constexpr int kTorso = 2, kLeftHip = 9, kRightHip = 12;

// A person who stands, with the left and the right foot's stands moved.
struct Stood {
  motion::Poses before, after;
  Footing footing;
};
Stood StandOn(Vec3 left, Vec3 right, int given = 0) {
  const motion::Poses person = Puppet();
  const BodyModel body = *BodyModel::Measure(motion::SbuSkeleton(), person);
  const Stance stance = MeasureStance(body, person);
  Stood stood{person, person, {stance.feet, {}}};
  for (Vec3& place : stood.footing.paths[0]) place += left;
  for (Vec3& place : stood.footing.paths[1]) place += right;
  stood.footing.standing.fill(std::vector<bool>(kFrames, true));
  StandOnFeet(body, stood.footing, stance, kRate, given, &stood.after);
  return stood;
}

float Stretch(const Stood& stood, std::size_t leg, int hip, int t) {
  return Distance(stood.after.at(t, hip), stood.footing.paths[leg][static_cast<std::size_t>(t)]);
}

TEST(StandOnFeetTest, TheBodyGoesWhereItsFeetWent) {
  const Stood stood = StandOn({0.1f, 0, 0}, {0.1f, 0, 0}, 5);
  EXPECT_EQ(stood.after[4], stood.before[4]) << "given";
  EXPECT_NEAR(stood.after.at(30, kTorso).x, stood.before.at(30, kTorso).x + 0.1f, 0.01f);
  EXPECT_NEAR(stood.after.at(30, kTorso).y, stood.before.at(30, kTorso).y, 0.005f);
}

TEST(StandOnFeetTest, ThePelvisRollsWhereTheLegsDisagree) {
  const Stood level = StandOn({}, {}), stood = StandOn({0, 0.02f, 0}, {0, -0.02f, 0});
  EXPECT_GT(stood.after.at(30, kLeftHip).y - stood.after.at(30, kRightHip).y, 0.03f);
  EXPECT_NEAR(Stretch(stood, 0, kLeftHip, 30), Stretch(level, 0, kLeftHip, 30), 0.005f);
  EXPECT_NEAR(Stretch(stood, 1, kRightHip, 30), Stretch(level, 1, kRightHip, 30), 0.005f);
}

TEST(StandOnFeetTest, LegsThatStayFoldedAreStretched) {
  const motion::Poses person = Puppet();
  const BodyModel body = *BodyModel::Measure(motion::SbuSkeleton(), person);
  Stance stance = MeasureStance(body, person);
  const float length = body.LegLength(0);
  stance.stretch[0].assign(kFrames, 0.7f * length);
  stance.stretch[1][30] = 0.7f * length;
  StretchLegs(body, kRate, &stance);
  EXPECT_NEAR(stance.stretch[0][30], 0.9f * length, 1e-3f);
  EXPECT_EQ(stance.stretch[1][30], 0.7f * length) << "a dip";
}

}  // namespace
}  // namespace duet::solver
