#include "model/cleanup/facing.h"

#include "model/base/angle.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Poses;
using motion::Vec3;

constexpr int kRoot = 2;

Poses Leader(float apart = 1) { return Moved(Puppet(), {0, 0, apart}); }

// A follower at the origin, turned away from a leader in front of it by `degrees(t)`.
template <typename Degrees>
Poses Turned(const Degrees& degrees) {
  return Changed(Puppet(), [&](int t, Vec3 joint) {
    return RotateY(joint, base::kRadiansPerDegree * degrees(t));
  });
}

std::vector<float> Away(const Poses& follower, double sigma_frames = 0.01) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  return DegreesAway(skeleton, body::FindBody(skeleton), Leader(), follower, sigma_frames);
}

Poses Facing(Poses follower, int settled = 0, float most = 50, const Poses& leader = Leader(),
             const motion::Skeleton& skeleton = motion::SbuSkeleton()) {
  FaceLeader(skeleton, body::FindBody(skeleton), leader, std::vector<float>(kFrames, most), {},
             {kRate, settled}, &follower);
  return follower;
}

TEST(DegreesAway, AreSignedAndWithoutShortTurns) {
  EXPECT_NEAR(Away(Turned([](int) { return 70.0; }))[20], -70, 0.5);
  EXPECT_NEAR(Away(Turned([](int) { return -130.0; }))[20], 130, 0.5);
  const Poses short_turn = Turned([](int t) { return t == 20 ? 90.0 : 0.0; });
  EXPECT_NEAR(Away(short_turn)[20], -90, 0.5);
  EXPECT_LT(std::abs(Away(short_turn, 5)[20]), 15);
  EXPECT_TRUE(
      DegreesAway(WithoutHips(), body::FindBody(WithoutHips()), Leader(), Puppet(), 1).empty());
}

TEST(FaceLeader, TurnsBackAFollowerThatStaysTurnedAway) {
  for (const double degrees : {90.0, -90.0, 170.0}) {
    const Poses before = Turned([&](int) { return degrees; });
    const Poses after = Facing(before);
    EXPECT_LT(std::abs(Away(after).back()), 26) << degrees;
    EXPECT_LT(LargestLengthChange(after, before), 1e-5f);
    for (int t = 0; t < kFrames; ++t) EXPECT_EQ(after.at(t, kRoot), before.at(t, kRoot));
  }
}

TEST(FaceLeader, TurnsTheShortWayNotFasterThanAPerson) {
  const std::vector<float> away = Away(Facing(Turned([](int) { return 120.0; })));
  for (std::size_t t = 1; t < away.size(); ++t) {
    EXPECT_GE(away[t], away[t - 1] - 0.1f) << t;
    EXPECT_LE(away[t] - away[t - 1], 110 / kRate + 0.1) << t;
    const float before = t > 1 ? away[t - 1] - away[t - 2] : 0;
    EXPECT_LE(away[t] - away[t - 1] - before, 110 / kRate / 4.5 + 0.1) << t;
  }
  EXPECT_NEAR(away[4], -120, 0.5);  // not at once
}

TEST(FaceLeader, AFollowerWithinItsLimitIsUnchanged) {
  const Poses oblique = Turned([](int) { return 48.0; });
  EXPECT_EQ(Facing(oblique), oblique);
  EXPECT_NE(Facing(oblique, 0, 40), oblique);
  const Poses opposite = Turned([](int) { return 180.0; });
  EXPECT_EQ(Facing(opposite, 0, 180), opposite);
}

TEST(FaceLeader, AShortTurnIsUnchanged) {
  const Poses dodge = Turned([](int t) { return t > 20 && t < 30 ? 80.0 : 0.0; });
  EXPECT_EQ(Facing(dodge), dodge);
}

TEST(FaceLeader, SettledFramesAreUnchangedAndTheTurnBeginsSlowly) {
  const Poses away = Turned([](int) { return 120.0; });
  const Poses after = Facing(away, 20);
  for (int t = 0; t < 20; ++t) EXPECT_EQ(after[t], away[t]);
  EXPECT_LT(Away(after)[20] - Away(after)[19], 110 / kRate / 4);
  EXPECT_LT(std::abs(Away(after).back()), 50);
}

TEST(FaceLeader, ATurnThatTheSettledFramesBeganGoesOn) {
  // Away for a second, then on the way back: 40 degrees is within the limit.
  const auto degrees = [](int t) { return t < 15 ? 100.0 : std::max(40.0, 100 - 7.0 * (t - 14)); };
  EXPECT_LT(std::abs(Away(Facing(Turned(degrees), 24)).back()), 27);
  const Poses still = Turned([](int) { return 40.0; });
  EXPECT_EQ(Facing(still, 24), still);
}

TEST(FaceLeader, ABodyThatTurnsByItselfIsNotTurnedTwice) {
  const Poses turning =
      Turned([](int t) { return std::max(0.0, 150.0 - 7 * std::max(0, t - 12)); });
  const Poses after = Facing(turning);
  EXPECT_LT(std::abs(Away(after).back()), 27);
  const std::vector<float> away = Away(after);
  for (std::size_t t = 1; t < away.size(); ++t) EXPECT_LT(away[t] - away[t - 1], 11) << t;
}

TEST(FaceLeader, BodiesTooNearToShowADirectionAreUnchanged) {
  const Poses away = Turned([](int) { return 120.0; });
  EXPECT_EQ(Facing(away, 0, 50, Leader(0.2f)), away);
}

TEST(FaceLeader, DoesNothingWithoutHips) {
  const Poses away = Turned([](int) { return 120.0; });
  EXPECT_EQ(Facing(away, 0, 50, Leader(), WithoutHips()), away);
}

}  // namespace
}  // namespace duet::cleanup
