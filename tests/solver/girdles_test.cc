#include "model/solver/girdles.h"

#include <gtest/gtest.h>

#include "model/body/limbs.h"
#include "model/motion/limb_lengths.h"
#include "tests/solver/noisy_person.h"

namespace duet::solver {
namespace {

using motion::Poses;

const motion::Skeleton& Sbu() {
  static const auto* const kSkeleton = new motion::Skeleton(motion::SbuSkeleton());
  return *kSkeleton;
}

float Width(const Poses& person, int t, const motion::JointPair& pair) {
  return Distance(person.at(t, pair.left), person.at(t, pair.right));
}

motion::JointPair Shoulders() {
  return {Sbu().Find("left_shoulder"), Sbu().Find("right_shoulder")};
}

// A person whose hips fold up, with bones of one length.
Poses Folding() {
  Poses person = WithCameraNoise(WalkingPerson(4));
  for (int t = 0; t < person.frame_count(); ++t) {
    const motion::Vec3 across = person.at(t, Sbu().hips->left) - person.at(t, Sbu().hips->right);
    const float share = 0.4f * static_cast<float>(t % 2);
    person.at(t, Sbu().hips->left) -= across * share;
    person.at(t, Sbu().hips->right) += across * share;
  }
  SetBoneLengths(Sbu(), MedianBoneLengths(Sbu(), person), &person);
  return person;
}

TEST(GirdlesTest, BothGetTheirWidths) {
  const Girdles girdles(Sbu());
  Poses person = Folding();
  ASSERT_LT(Width(person, 1, *Sbu().hips), 0.6f * Width(person, 0, *Sbu().hips));
  const std::vector<float> bones = MedianBoneLengths(Sbu(), person);
  for (int t = 0; t < person.frame_count(); ++t) {
    girdles.Apply({0.18f, 0.29f}, person[t]);
    EXPECT_NEAR(Width(person, t, *Sbu().hips), 0.18f, 1e-4) << t;
    EXPECT_NEAR(Width(person, t, Shoulders()), 0.29f, 1e-4) << t;
  }
  const std::vector<float> after = MedianBoneLengths(Sbu(), person);
  for (std::size_t b = 0; b < bones.size(); ++b) EXPECT_NEAR(after[b], bones[b], 1e-4) << b;
}

TEST(GirdlesTest, LimbsMoveAlongAndKeepTheirBend) {
  const Girdles girdles(Sbu());
  Poses person = Folding();
  const double knees = KneeDegrees(person);
  for (int t = 0; t < person.frame_count(); ++t) girdles.Apply({0.18f, 0.29f}, person[t]);
  EXPECT_NEAR(KneeDegrees(person), knees, 1e-3);
}

TEST(GirdlesTest, FeetAndHandsStayIfTheyAreTo) {
  const Girdles girdles(Sbu());
  const Poses walking = WalkingPerson(4);
  Poses person = walking;
  const GirdleWidths widths = girdles.Measure(person);
  for (int t = 0; t < person.frame_count(); ++t) {
    girdles.ApplyAboveFeet({0.9f * widths.hips, 0.9f * widths.shoulders}, person[t]);
    for (const char* joint : {"left_foot", "right_foot", "left_hand", "right_hand"}) {
      const int j = Sbu().Find(joint);
      EXPECT_LT(Distance(person.at(t, j), walking.at(t, j)), 0.01f) << joint << " " << t;
    }
  }
}

TEST(GirdlesTest, StraightLegsBendForwards) {
  const Girdles girdles(Sbu());
  Poses person = WalkingPerson(0);
  for (const body::Limb& leg : body::FindBody(Sbu()).legs) {
    const motion::Vec3 hip = person.at(0, leg.upper);
    person.at(0, leg.middle) = hip + motion::Vec3{0, -0.42f, 0};
    person.at(0, leg.end) = hip + motion::Vec3{0, -0.84f, 0};
  }
  const motion::Vec3 facing = body::Facing(*Sbu().hips, person[0]);
  for (motion::Vec3& joint : person.all()) joint.y *= 0.999f;
  GirdleWidths widths = girdles.Measure(person);
  // Narrower hips hang lower: the knees have to give way.
  girdles.ApplyAboveFeet({0.7f * widths.hips, widths.shoulders}, person[0]);
  for (const body::Limb& leg : body::FindBody(Sbu()).legs) {
    EXPECT_GT(Dot(body::BendOf(leg, person[0]), facing), 0.01f);
  }
}

TEST(GirdlesTest, APersonOfTheseWidthsStaysAsItIs) {
  const Girdles girdles(Sbu());
  const Poses walking = WalkingPerson(4);
  Poses person = walking;
  const GirdleWidths widths = girdles.Measure(person);
  for (int t = 0; t < person.frame_count(); ++t) girdles.Apply(widths, person[t]);
  EXPECT_LT(MeanDistance(person, walking), 1e-4);
}

TEST(GirdlesTest, NoWiderThanTheirBones) {
  const Girdles girdles(Sbu());
  Poses person = WalkingPerson(1);
  girdles.Apply({5, 5}, person[0]);
  for (const motion::Vec3& joint : person.all()) EXPECT_TRUE(IsFinite(joint));
  EXPECT_LT(Width(person, 0, *Sbu().hips), 1);
}

TEST(GirdlesTest, ASkeletonWithoutThemIsLeftAlone) {
  motion::Skeleton skeleton = Sbu();
  skeleton.hips.reset();
  skeleton.feet.reset();
  const Girdles girdles(skeleton);
  Poses person = Folding();
  const Poses before = person;
  EXPECT_EQ(girdles.Measure(person).hips, 0);
  girdles.Apply({0.3f, 0.3f}, person[0]);
  EXPECT_EQ(person, before);
}

}  // namespace
}  // namespace duet::solver
