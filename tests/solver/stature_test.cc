#include "model/solver/stature.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/authoring/made_leaders.h"
#include "tests/solver/noisy_person.h"

namespace duet::solver {
namespace {

using motion::Poses;

constexpr int kFrames = 45;

const std::vector<body::Limb>& Legs() {
  static const auto* const kLegs =
      new std::vector<body::Limb>(body::FindBody(motion::SbuSkeleton()).legs);
  return *kLegs;
}

Poses Standing() {
  const Poses person = authoring::StandingPerson();
  Poses still(0, person.joint_count());
  for (int t = 0; t < kFrames; ++t) still.Append(person.all());
  return still;
}

// Lowers the body above its feet by `metres(t)`.
template <typename Metres>
Poses Lowered(Poses person, const Metres& metres) {
  for (int t = 0; t < person.frame_count(); ++t) {
    const motion::Vec3 feet[] = {person.at(t, Legs()[0].end), person.at(t, Legs()[1].end)};
    for (motion::Vec3& joint : person[t]) joint.y -= metres(t);
    for (const std::size_t leg : {std::size_t{0}, std::size_t{1}}) {
      body::ReachBent(Legs()[leg], feet[leg], {0, 0, -1}, person[t]);
    }
  }
  return person;
}
Poses Lowered(Poses person, float metres) {
  return Lowered(std::move(person), [metres](int) { return metres; });
}

Poses Kept(const Poses& person, const Stretches& wanted, int settled = 0, double least = 0.9) {
  Poses kept = person;
  StatureOptions options{kRate, settled, least};
  KeepStature(Legs(), wanted, options, &kept);
  return kept;
}

float FeetMoved(const Poses& a, const Poses& b) {
  float most = 0;
  for (int t = 0; t < a.frame_count(); ++t) {
    for (const body::Limb& leg : Legs()) {
      most = std::max(most, Distance(a.at(t, leg.end), b.at(t, leg.end)));
    }
  }
  return most;
}

TEST(StatureTest, LegsAreAsStretchedAsTheyWere) {
  const Poses person = Standing();
  const Poses low = Lowered(person, 0.06f);
  ASSERT_GT(KneeDegrees(low), KneeDegrees(person) + 20);
  const Poses kept = Kept(low, MeasureStretches(Legs(), person));
  EXPECT_NEAR(KneeDegrees(kept), KneeDegrees(person), 4);
  EXPECT_LT(FeetMoved(kept, low), 0.002f);
}

TEST(StatureTest, ABodyThatIsTooHighComesDown) {
  const Poses person = Standing();
  const Poses kneeling = Lowered(person, 0.05f);
  const Poses kept = Kept(person, MeasureStretches(Legs(), kneeling), 0, 0);
  EXPECT_NEAR(KneeDegrees(kept), KneeDegrees(kneeling), 3);
}

TEST(StatureTest, EndsACrouchThatTheNetworkHas) {
  const Poses crouching = Lowered(Standing(), 0.25f);
  ASSERT_LT(LastingHipHeights(Legs(), crouching, kRate)[20], 0.8f);
  const Poses kept = Kept(crouching, MeasureStretches(Legs(), crouching));
  EXPECT_NEAR(LastingHipHeights(Legs(), kept, kRate)[20], 0.9, 0.01);
  EXPECT_LT(FeetMoved(kept, crouching), 0.002f);
}

TEST(StatureTest, KeepsAShortDip) {
  const Poses dip = Lowered(Standing(), [](int t) { return t >= 20 && t < 23 ? 0.15f : 0.0f; });
  const Poses kept = Kept(dip, MeasureStretches(Legs(), dip));
  const int root = motion::SbuSkeleton().root;
  EXPECT_NEAR(kept.at(21, root).y, dip.at(21, root).y, 0.02);
}

TEST(StatureTest, SettledFramesStayAndTheRestFollowsSmoothly) {
  const Poses low = Lowered(Standing(), 0.06f);
  const Poses kept = Kept(low, MeasureStretches(Legs(), Standing()), 10);
  const int root = motion::SbuSkeleton().root;
  for (int t = 0; t < 10; ++t) EXPECT_EQ(kept.at(t, root), low.at(t, root)) << t;
  float before = 0;
  for (int t = 10; t < kFrames; ++t) {
    const float rise = kept.at(t, root).y - low.at(t, root).y;
    EXPECT_LT(rise - before, 0.03f) << t;
    before = rise;
  }
  EXPECT_GT(before, 0.03f);
}

TEST(StatureTest, NobodyRisesFartherThanTheLegsReach) {
  const Poses person = Standing();
  const Stretches endless(2, std::vector<float>(kFrames, 2));
  const Poses kept = Kept(person, endless, 0, 1.5);
  EXPECT_LT(FeetMoved(kept, person), 0.002f);
  for (const motion::Vec3& joint : kept.all()) EXPECT_TRUE(IsFinite(joint));
}

TEST(StatureTest, NeedsLegsAndFrames) {
  Poses person = Standing();
  const Poses before = person;
  KeepStature({}, {}, {kRate}, &person);
  EXPECT_EQ(person, before);
  Poses none(0, 15);
  KeepStature(Legs(), {{}, {}}, {kRate}, &none);
  EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace duet::solver
