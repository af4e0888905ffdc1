#include "model/solver/partner.h"

#include <cmath>

#include "gtest/gtest.h"
#include "model/base/angle.h"
#include "tests/support/bodies.h"

namespace duet::solver {
namespace {

using motion::Vec3;
using test::kFrames;
using test::kRate;
using test::Moved;
using test::Puppet;

constexpr int kTorso = 2, kRightHand = 8;

struct Fixture {
  motion::Skeleton skeleton = motion::SbuSkeleton();
  body::Body body = body::FindBody(skeleton);
  Partner partner{skeleton, body};
};

// Faces the leader from `metres` away, turned by `degrees` from there.
motion::Poses Opposite(double metres, double degrees = 0) {
  return Moved(test::Changed(Puppet(),
                             [=](int, Vec3 joint) {
                               return RotateY(joint, (180 + degrees) * base::kRadiansPerDegree);
                             }),
               {0, 0, static_cast<float>(metres)});
}

ContactRules Rules(ContactRule rule = {}) { return ContactRules(kFrames, rule); }

float Apart(const motion::Poses& leader, const motion::Poses& follower, int t) {
  return Distance(leader.at(t, kTorso), follower.at(t, kTorso));
}

TEST(PartnerTest, LeavesPeopleWhoStandApartFaceToFace) {
  const Fixture f;
  motion::Poses follower = Opposite(1);
  const motion::Poses before = follower;
  f.partner.PlaceBody(Puppet(), Rules({0, 0, 0, 60}), kRate, 0, &follower);
  f.partner.PlaceHands(Puppet(), Rules(), kRate, 0, &follower);
  EXPECT_LT(test::LargestDistance(follower, before), 0.001f);
}

TEST(PartnerTest, PartsBodiesUnlessTheyMayOverlap) {
  const Fixture f;
  motion::Poses parted = Opposite(0.1), hugging = parted;
  f.partner.PlaceBody(Puppet(), Rules(), kRate, 0, &parted);
  f.partner.PlaceBody(Puppet(), Rules({1}), kRate, 0, &hugging);
  EXPECT_GT(Apart(Puppet(), parted, 20), 0.17f);
  EXPECT_GT(Apart(Puppet(), hugging, 20), 0.15f);
  EXPECT_LE(Apart(Puppet(), hugging, 20), Apart(Puppet(), parted, 20));
}

TEST(PartnerTest, ComesBackFromFarAway) {
  const Fixture f;
  motion::Poses follower = Opposite(4);
  f.partner.PlaceBody(Puppet(), Rules(), kRate, 0, &follower);
  EXPECT_LT(Apart(Puppet(), follower, 20), 2.8f);
}

TEST(PartnerTest, TurnsBackAsFarAsTheRuleSays) {
  const Fixture f;
  const auto away = [&](ContactRule rule) {
    motion::Poses follower = Opposite(1, 120);
    f.partner.PlaceBody(Puppet(), Rules(rule), kRate, 0, &follower);
    return std::abs(DegreesAway(f.skeleton, f.body, Puppet(), follower, kRate)[30]);
  };
  EXPECT_NEAR(away({0, 0, 0, 180}), 120, 1);
  EXPECT_LT(away({0, 0, 0, 50}), 65);
}

TEST(PartnerTest, MeetsAHandThatIsOffered) {
  const Fixture f;
  const motion::Poses leader = Puppet([](double, authoring::PuppetPose* pose) {
    pose->right_hand.target = {-0.15, 0, 0.7};
  });
  const auto apart = [&](float hands) {
    const motion::Poses before = Opposite(1.1);
    motion::Poses follower = before;
    f.partner.PlaceBody(leader, Rules({0, hands, 0.1f}), kRate, 0, &follower);
    f.partner.PlaceHands(leader, Rules({0, hands, 0.1f}), kRate, 0, &follower);
    EXPECT_LT(test::LargestLengthChange(follower, before), 1e-4f);
    const Vec3 hand = leader.at(25, kRightHand);
    return std::min(Distance(hand, follower.at(25, kRightHand)),
                    Distance(hand, follower.at(25, 5)));
  };
  EXPECT_LT(apart(1), 0.15f);
  EXPECT_GT(apart(0), 0.4f);
}

TEST(PartnerTest, LeavesTheGivenFrames) {
  const Fixture f;
  motion::Poses follower = Opposite(0.1, 120);
  const motion::Poses before = follower;
  f.partner.PlaceBody(Puppet(), Rules({0, 1, 0.1f, 50}), kRate, 12, &follower);
  f.partner.PlaceHands(Puppet(), Rules({0, 1, 0.1f, 50}), kRate, 12, &follower);
  for (int t = 0; t < 12; ++t) EXPECT_EQ(follower[t], before[t]) << t;
  EXPECT_NE(follower[30], before[30]);
  EXPECT_LT(test::LargestStep(follower), 0.15f);
}

}  // namespace
}  // namespace duet::solver
