#include "model/solver/partner.h"

#include <cmath>
#include <cstddef>

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

  void Body(const motion::Poses& leader, const ContactRules& rules, motion::Poses* follower,
            int given = 0) const {
    PlaceBody({skeleton, body, leader, rules, kRate, given}, follower);
  }
  void Hands(const motion::Poses& leader, const ContactRules& rules, motion::Poses* follower,
             int given = 0) const {
    PlaceHands({skeleton, body, leader, rules, kRate, given}, follower);
  }
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
  f.Body(Puppet(), Rules({0, 0, 0, 60}), &follower);
  f.Hands(Puppet(), Rules(), &follower);
  EXPECT_LT(test::LargestDistance(follower, before), 0.001f);
}

TEST(PartnerTest, PartsBodiesUnlessTheyMayOverlap) {
  const Fixture f;
  motion::Poses parted = Opposite(0.1), hugging = parted;
  f.Body(Puppet(), Rules(), &parted);
  f.Body(Puppet(), Rules({1}), &hugging);
  EXPECT_GT(Apart(Puppet(), parted, 20), 0.17f);
  EXPECT_GT(Apart(Puppet(), hugging, 20), 0.15f);
  EXPECT_LE(Apart(Puppet(), hugging, 20), Apart(Puppet(), parted, 20));
}

TEST(PartnerTest, ComesBackFromFarAway) {
  const Fixture f;
  motion::Poses follower = Opposite(4);
  f.Body(Puppet(), Rules(), &follower);
  EXPECT_LT(Apart(Puppet(), follower, 20), 2.8f);
}

TEST(PartnerTest, TurnsBackAsFarAsTheRuleSays) {
  const Fixture f;
  const auto away = [&](ContactRule rule) {
    motion::Poses follower = Opposite(1, 120);
    f.Body(Puppet(), Rules(rule), &follower);
    return std::abs(DegreesAway(f.skeleton, f.body, Puppet(), follower, kRate)[30]);
  };
  EXPECT_NEAR(away({0, 0, 0, 180}), 120, 1);
  EXPECT_LT(away({0, 0, 0, 50}), 65);
}

TEST(PartnerTest, MeetsAHandThatIsOffered) {
  const Fixture f;
  const motion::Poses leader = Puppet([](double, test::PuppetPose* pose) {
    pose->right_hand.target = {-0.15, 0, 0.7};
  });
  const auto apart = [&](float hands) {
    const motion::Poses before = Opposite(1.1);
    motion::Poses follower = before;
    f.Body(leader, Rules({0, hands, 0.1f}), &follower);
    f.Hands(leader, Rules({0, hands, 0.1f}), &follower);
    EXPECT_LT(test::LargestLengthChange(follower, before), 1e-4f);
    const Vec3 hand = leader.at(25, kRightHand);
    return std::min(Distance(hand, follower.at(25, kRightHand)),
                    Distance(hand, follower.at(25, 5)));
  };
  EXPECT_LT(apart(1), 0.15f);
  EXPECT_GT(apart(0), 0.4f);
}

// Two people in an embrace, whose hands hang down in front of each other.
struct Embrace {
  Fixture f;
  motion::Poses leader = Puppet(), before;
  ContactRule rule;

  explicit Embrace(double metres) : before(Opposite(metres)) {
    rule.overlap = 1;
    rule.holds = {{{1, {-0.4f, 0.6f, -0.2f}}, {1, {0.3f, 0.8f, -0.3f}}}};
    for (int t = 0; t < kFrames; ++t) {
      for (const body::Limb& arm : f.body.arms) {
        body::Reach(arm, before.at(t, arm.upper) + Vec3{0, -0.2f, -0.3f}, {0, 0, 1}, before[t]);
      }
    }
  }
  motion::Poses Held(motion::Poses follower) const {
    f.Hands(leader, Rules(rule), &follower);
    return follower;
  }
};

TEST(PartnerTest, HandsHoldTheTrunkOfACloseLeader) {
  const Embrace close(0.3), apart(0.8);
  const motion::Poses follower = close.Held(close.before);
  EXPECT_LT(test::LargestLengthChange(follower, close.before), 1e-4f);
  const TrunkAxes trunk = TrunkAxesOf(close.f.skeleton, close.f.body, close.leader[25]);
  for (std::size_t arm = 0; arm < 2; ++arm) {
    const Vec3 hand = follower.at(25, close.f.body.arms[arm].end);
    EXPECT_LT(Distance(hand, trunk.WorldOf(close.rule.holds[arm].place)), 0.06f) << arm;
    EXPECT_LT(trunk.PlaceOf(hand).z, 0) << arm << " is not behind the leader";
  }
  EXPECT_EQ(apart.Held(apart.before).all(), apart.before.all());
}

// A client's joints are rounded on the way: they must not move the hands.
TEST(PartnerTest, RoundingMovesHandsThatHoldNoFarther) {
  for (double metres = 0.2; metres < 0.62; metres += 0.02) {
    const Embrace embrace(metres);
    motion::Poses rounded = embrace.before;
    for (Vec3& joint : rounded.all()) joint += Vec3{1e-5f, -1e-5f, 1e-5f};
    EXPECT_LT(test::LargestDistance(embrace.Held(embrace.before), embrace.Held(rounded)), 2e-4f)
        << metres;
  }
}

TEST(PartnerTest, LeavesTheGivenFrames) {
  const Fixture f;
  motion::Poses follower = Opposite(0.1, 120);
  const motion::Poses before = follower;
  f.Body(Puppet(), Rules({0, 1, 0.1f, 50}), &follower, 12);
  f.Hands(Puppet(), Rules({0, 1, 0.1f, 50}), &follower, 12);
  for (int t = 0; t < 12; ++t) EXPECT_EQ(follower[t], before[t]) << t;
  EXPECT_NE(follower[30], before[30]);
  EXPECT_LT(test::LargestStep(follower), 0.15f);
}

}  // namespace
}  // namespace duet::solver
