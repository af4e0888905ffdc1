#include "model/engine/capture_fits.h"

#include "gmock/gmock.h"
#include "model/base/angle.h"
#include "model/solver/partner.h"
#include "tests/support/bodies.h"

namespace duet::engine {
namespace {

using motion::Poses;
using motion::Vec3;
using test::kFrames;
using test::kRate;
using test::Puppet;
using testing::Each;
using testing::IsEmpty;
using testing::SizeIs;

constexpr int kTorso = 2, kLeftHand = 5, kRightElbow = 7, kRightHand = 8;

struct Pair {
  Poses leader, follower;

  Stretch First(int frames) const { return {&leader, &follower, 0, frames}; }
};

Stretches Whole(const std::vector<Pair>& pairs) {
  Stretches stretches;
  for (const Pair& pair : pairs) stretches.push_back(pair.First(pair.leader.frame_count()));
  return stretches;
}

// Pairs whose followers have these sizes; the leaders have 1.
std::vector<double> Ratios(const std::vector<double>& sizes) {
  std::vector<Pair> pairs;
  for (const double size : sizes) {
    pairs.push_back({Puppet(), test::Changed(Puppet(), [size](int, Vec3 joint) {
                       return joint * static_cast<float>(size);
                     })});
  }
  return BoneRatios(motion::SbuSkeleton(), Whole(pairs));
}

TEST(BoneRatios, FollowersWhoAreSmallerOrLargerHaveThem) {
  EXPECT_THAT(Ratios({0.9, 0.88, 0.9}), SizeIs(motion::SbuSkeleton().bones.size()));
  EXPECT_THAT(Ratios({0.9, 0.88, 0.9}), Each(testing::DoubleNear(0.9, 1e-3)));
  EXPECT_THAT(Ratios({1.2}), Each(testing::DoubleNear(1.2, 1e-3)));
}

TEST(BoneRatios, AnyTwoPeopleHaveNone) {
  for (const std::vector<double>& sizes :
       {std::vector<double>{}, {1, 1, 1}, {0.9, 0.9, 0.9, 1.1, 1.1}, {0.99}}) {
    EXPECT_THAT(Ratios(sizes), IsEmpty());
  }
}

// A follower who is turned away by `degrees` from a leader in front of it, from a frame on.
Pair Turned(double degrees, int from = 0) {
  return {test::Moved(Puppet(), {0, 0, 1}), test::Changed(Puppet(), [=](int t, Vec3 joint) {
            return t < from ? joint : RotateY(joint, degrees * base::kRadiansPerDegree);
          })};
}

std::optional<double> Facing(const Stretches& stretches) {
  return FacingDegrees(motion::SbuSkeleton(), stretches, kRate);
}

TEST(FacingDegrees, AreHowFarFollowersAreTurnedAway) {
  std::vector<Pair> pairs(8, Turned(-10));
  pairs.push_back(Turned(40));
  pairs.push_back(Turned(60));
  EXPECT_NEAR(Facing(Whole(pairs)).value(), 40, 5);
}

TEST(FacingDegrees, CountOnlyTheFramesOfTheStretch) {
  const Pair late = Turned(170, 20);
  EXPECT_NEAR(Facing(Stretches(8, late.First(20))).value(), 0, 0.5);
}

TEST(FacingDegrees, PeopleSideBySideAndAFewFramesHaveNone) {
  EXPECT_FALSE(Facing(Whole({Turned(90)})).has_value());
  EXPECT_FALSE(Facing({}).has_value());
  const Pair pair = Turned(0);
  EXPECT_FALSE(Facing({pair.First(kFrames - 2)}).has_value());
}

// A leader who stretches out a hand, and a follower whose hand is `gap` away from it.
Pair Offering(float gap) {
  Pair pair = {Puppet(), test::Moved(Puppet(), {0, 0, 1.2f})};
  for (int t = 0; t < kFrames; ++t) {
    const Vec3 torso = pair.leader.at(t, kTorso);
    pair.leader.at(t, kRightElbow) = torso + Vec3{0, 0.2f, 0.35f};
    pair.leader.at(t, kRightHand) = torso + Vec3{0, 0.2f, 0.6f};
    pair.follower.at(t, kRightHand) = pair.leader.at(t, kRightHand) + Vec3{0, 0, gap};
  }
  return pair;
}

std::optional<double> Metres(const Stretches& stretches) {
  return HandContactMetres(motion::SbuSkeleton(), stretches, kRate);
}

TEST(HandContactMetres, IsTheDistanceOfHandsThatMeetForLongEnough) {
  const Pair meets = Offering(0.1f);
  EXPECT_NEAR(Metres({meets.First(kFrames)}).value(), 0.1, 1e-6);
  // Hands that come and go do not count.
  EXPECT_NEAR(Metres(Whole({meets, Offering(0.2f), Offering(0.24f)})).value(), 0.1, 1e-6);
  EXPECT_FALSE(Metres({meets.First(kFrames - 5)}).has_value());
  EXPECT_FALSE(Metres(Whole({Offering(0.4f)})).has_value());
}

// One long stretch in which hands meet must not decide about a class in which they seldom do.
TEST(HandContactMetres, CountsEveryStretchTheSame) {
  const Pair meets = Offering(0.1f), misses = Offering(0.4f);
  Stretches stretches = {meets.First(kFrames)};
  for (int t = 0; t < 6; t += 2) stretches.push_back({&misses.leader, &misses.follower, t, t + 2});
  EXPECT_FALSE(Metres(stretches).has_value());
}

// Two people face to face at `metres`; the follower's left hand is at a place of the leader's
// trunk.
Pair Embracing(float metres, Vec3 place) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const body::Body body = body::FindBody(skeleton);
  Pair pair = {Puppet(),
               test::Moved(test::Changed(Puppet(),
                                         [](int, Vec3 joint) { return RotateY(joint, base::kPi); }),
                           {0, 0, metres})};
  for (int t = 0; t < kFrames; ++t) {
    pair.follower.at(t, kLeftHand) =
        solver::TrunkAxesOf(skeleton, body, pair.leader[t]).WorldOf(place);
  }
  return pair;
}

std::vector<TrunkContact> Held(const std::vector<Pair>& pairs) {
  return TrunkContacts(motion::SbuSkeleton(), Whole(pairs), kRate);
}

TEST(TrunkContacts, AreTheHandsThatRestOnAPartnerAndWhere) {
  const std::vector<TrunkContact> held =
      Held({Embracing(0.3f, {-0.3f, 0.5f, -0.2f}), Embracing(0.3f, {-0.3f, 0.7f, -0.2f})});
  ASSERT_THAT(held, SizeIs(1));
  EXPECT_EQ(held[0].hand, "left_hand");
  EXPECT_LT(Distance(held[0].place, {-0.3f, 0.7f, -0.2f}), 1e-4f);
}

TEST(TrunkContacts, NeedPeopleWhoAreCloseAndHandsAtTheTrunk) {
  const Vec3 place = {-0.3f, 0.5f, -0.2f}, inside = {0.05f, 0.5f, 0}, away = {-0.8f, 0.5f, 0};
  EXPECT_THAT(Held({Embracing(0.6f, place)}), IsEmpty());
  EXPECT_THAT(Held({Embracing(0.3f, inside)}), IsEmpty());
  EXPECT_THAT(Held({Embracing(0.3f, away)}), IsEmpty());
  std::vector<Pair> seldom(9, Embracing(0.3f, away));
  seldom.push_back(Embracing(0.3f, place));
  EXPECT_THAT(Held(seldom), IsEmpty());
}

}  // namespace
}  // namespace duet::engine
