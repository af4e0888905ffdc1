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

}  // namespace
}  // namespace duet::body
