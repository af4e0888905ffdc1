#include "model/cleanup/hand_contact.h"

#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr int kRightShoulder = 6, kRightHand = 8, kTorso = 2;
constexpr float kApart = 1.1f;  // of the two people

// Stretches out the right hand from the first second on.
motion::Poses Offering() {
  return Puppet([](double t, authoring::PuppetPose* pose) {
    const double share = std::min(1.0, t);
    pose->right_hand.target = {-0.15, -0.45 + 0.35 * share, 0.1 + 0.35 * share};
  });
}

// Stands opposite, facing the leader, with hanging arms.
motion::Poses Opposite() {
  return Changed(Puppet(), [](int, Vec3 joint) {
    return Vec3{-joint.x, joint.y, kApart - joint.z};
  });
}

Meetings Wanted(float weight = 1) { return Meetings(kFrames, {weight, 0.1f}); }

motion::Poses Met(const motion::Poses& leader, motion::Poses follower, const Meetings& meetings,
                  int settled = 0, const motion::Skeleton& skeleton = motion::SbuSkeleton()) {
  const body::Body body = body::FindBody(skeleton);
  const Timing timing{kRate, settled};
  ApproachHand(skeleton, body, leader, meetings, {}, timing, &follower);
  MeetHand(skeleton, body, leader, meetings, {}, timing, &follower);
  return follower;
}

// The distance of the leader's right hand from the follower's nearest hand.
float Gap(const motion::Poses& leader, const motion::Poses& follower, int frame) {
  return std::min(Distance(leader.at(frame, kRightHand), follower.at(frame, 5)),
                  Distance(leader.at(frame, kRightHand), follower.at(frame, kRightHand)));
}

TEST(HandContact, MeetsAHandThatIsOffered) {
  const motion::Poses leader = Offering(), met = Met(leader, Opposite(), Wanted());
  EXPECT_GT(Gap(leader, Opposite(), kFrames - 1), 0.4f);
  EXPECT_NEAR(Gap(leader, met, kFrames - 1), 0.1f, 0.03f);
  EXPECT_LT(LargestLengthChange(met, Opposite()), 1e-4f);
  EXPECT_LT(LargestStep(met), 0.15f);
}

TEST(HandContact, AHangingHandIsNotMet) {
  EXPECT_LT(LargestDistance(Met(Puppet(), Opposite(), Wanted()), Opposite()), 1e-3f);
}

TEST(HandContact, OnlyWhereTheLabelsAskForIt) {
  EXPECT_EQ(Met(Offering(), Opposite(), Wanted(0)), Opposite());
  const motion::Poses leader = Offering();
  const float half = Gap(leader, Met(leader, Opposite(), Wanted(0.5f)), kFrames - 1);
  EXPECT_GT(half, 0.15f);
  EXPECT_LT(half, Gap(leader, Opposite(), kFrames - 1) - 0.1f);
}

TEST(HandContact, TheBodyComesNearerWhereTheArmIsTooShort) {
  const motion::Poses leader = Offering();
  const motion::Poses far = Changed(Opposite(), [](int, Vec3 joint) {
    return joint + Vec3{0, 0, 0.3f};
  });
  const motion::Poses met = Met(leader, far, Wanted());
  EXPECT_LT(met.at(kFrames - 1, kTorso).z, far.at(kFrames - 1, kTorso).z - 0.1f);
  EXPECT_LT(Gap(leader, met, kFrames - 1), 0.2f);
}

TEST(HandContact, TheBodyLeavesOutTheLastPartOfItsWay) {
  const motion::Poses leader = Offering();
  const motion::Poses far = Changed(Opposite(), [](int, Vec3 joint) {
    return joint + Vec3{0, 0, 0.3f};
  });
  Meetings meetings = Wanted();
  for (Meeting& meeting : meetings) meeting.left_out_metres = 0.1f;
  const motion::Poses whole = Met(leader, far, Wanted()), part = Met(leader, far, meetings);
  const auto way = [&](const motion::Poses& met) {
    return far.at(kFrames - 1, kTorso).z - met.at(kFrames - 1, kTorso).z;
  };
  EXPECT_NEAR(way(part), way(whole) - 0.1f, 0.02f);
  EXPECT_GT(way(part), 0.02f);
}

TEST(HandContact, LeavesSettledFramesAndDoesNotJump) {
  const motion::Poses leader = Offering(), met = Met(leader, Opposite(), Wanted(), 30);
  for (int t = 0; t < 30; ++t) EXPECT_EQ(met[t], Opposite()[t]);
  EXPECT_LT(LargestStep(met), 0.15f);
  EXPECT_LT(Gap(leader, met, kFrames - 1), 0.2f);
}

// The right hand is offered in the first second and a half, and then the left one.
motion::Poses OfferingBoth() {
  return Puppet([](double t, authoring::PuppetPose* pose) {
    auto& hand = t < 1.5 ? pose->right_hand : pose->left_hand;
    hand.target = {t < 1.5 ? -0.15 : 0.15, -0.1, 0.45};
  });
}

TEST(HandContact, MeetsEachHandWhileItIsOffered) {
  const motion::Poses leader = OfferingBoth(), met = Met(leader, Opposite(), Wanted());
  EXPECT_LT(Gap(leader, met, 8), 0.15f);
  const auto left_gap = [&](int frame) {
    return std::min(Distance(leader.at(frame, 5), met.at(frame, 5)),
                    Distance(leader.at(frame, 5), met.at(frame, kRightHand)));
  };
  EXPECT_LT(left_gap(kFrames - 5), 0.15f);
}

TEST(HandContact, NeedsTwoNamedArms) {
  EXPECT_EQ(Met(Offering(), Opposite(), Wanted(), 0, WithoutHips()), Opposite());
}

}  // namespace
}  // namespace duet::cleanup
