#include "model/body/build.h"

#include <gtest/gtest.h>

#include "model/authoring/made_leaders.h"

namespace duet::body {
namespace {

const motion::Skeleton& Sbu() {
  static const auto* const kSkeleton = new motion::Skeleton(motion::SbuSkeleton());
  return *kSkeleton;
}

motion::Poses Standing(int frames) {
  const motion::Poses person = authoring::StandingPerson();
  motion::Poses still(0, person.joint_count());
  for (int t = 0; t < frames; ++t) still.Append(person.all());
  return still;
}

BuildFigures Measure(const motion::Poses& person) {
  return MeasureBuild(Sbu(), FindBody(Sbu()), person);
}

TEST(BuildTest, APersonWhoStands) {
  const BuildFigures figures = Measure(Standing(5));
  EXPECT_NEAR(figures.HipsOff(), 0, 1e-6);
  EXPECT_GT(figures.hips_over_leg, 0.9);
  EXPECT_LT(figures.hips_over_leg, 1);
  EXPECT_LT(figures.knee_degrees, 40);
}

TEST(BuildTest, HipsThatFoldUpOrSpread) {
  motion::Poses person = Standing(5);
  const motion::JointPair hips = *Sbu().hips;
  const motion::Vec3 across = person.at(0, hips.left) - person.at(0, hips.right);
  person.at(3, hips.left) = person.at(3, hips.right) + across * 0.4f;
  EXPECT_NEAR(Measure(person).narrowest_hips, 0.4, 1e-5);
  EXPECT_NEAR(Measure(person).HipsOff(), 0.6, 1e-5);
  person.at(1, hips.left) = person.at(1, hips.right) + across * 1.9f;
  EXPECT_NEAR(Measure(person).widest_hips, 1.9, 1e-5);
  EXPECT_NEAR(Measure(person).HipsOff(), 0.9, 1e-5);
}

TEST(BuildTest, ACrouchBendsKneesAndLowersHips) {
  motion::Poses person = Standing(1);
  const BuildFigures standing = Measure(person);
  const Body body = FindBody(Sbu());
  for (motion::Vec3& joint : person.all()) joint.y -= 0.2f;
  const motion::Poses still = Standing(1);
  for (const Limb& leg : body.legs) {
    ReachBent(leg, still.at(0, leg.end), {0, 0, -1}, person[0]);
  }
  const BuildFigures crouching = Measure(person);
  EXPECT_GT(crouching.knee_degrees, standing.knee_degrees + 40);
  EXPECT_LT(crouching.hips_over_leg, standing.hips_over_leg - 0.2);
}

StillnessFigures Stillness(const motion::Poses& person) {
  return MeasureStillness(Sbu(), FindBody(Sbu()), person, /*frame_rate_hz=*/15);
}

TEST(StillnessTest, APersonWhoStandsStillDoesNotMove) {
  const StillnessFigures figures = Stillness(Standing(30));
  EXPECT_EQ(figures.joint_speed, 0);
  EXPECT_EQ(figures.hand_over_shoulder, 0);
  EXPECT_GT(figures.feet_apart, 0.05);
  EXPECT_LT(figures.feet_apart, 0.4);
}

TEST(StillnessTest, CountsFramesInWhichEitherHandIsAboveItsShoulder) {
  motion::Poses person = Standing(10);
  const Body body = FindBody(Sbu());
  for (int t = 0; t < 4; ++t) {
    const Limb& arm = body.arms[static_cast<std::size_t>(t % 2)];
    person.at(t, arm.end).y = person.at(t, arm.upper).y + 0.01f;
  }
  EXPECT_DOUBLE_EQ(Stillness(person).hand_over_shoulder, 0.4);
}

TEST(StillnessTest, FeetApartIgnoresTheWidestTenthAndHeights) {
  motion::Poses person = Standing(21);
  const motion::JointPair feet = *Sbu().feet;
  for (int t = 0; t < 21; ++t) {
    person.at(t, feet.left) = person.at(t, feet.right) + motion::Vec3{0.3f, 0.2f, 0.4f};
  }
  person.at(7, feet.left).x += 2;
  EXPECT_NEAR(Stillness(person).feet_apart, 0.5, 1e-5);
}

}  // namespace
}  // namespace duet::body
