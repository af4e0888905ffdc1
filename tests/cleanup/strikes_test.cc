#include "model/cleanup/strikes.h"

#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr int kTorso = 2, kRightHand = 8, kKicker = 14;
constexpr float kApart = 1.25f, kNear = 0.1f;
// The frame in which the fist or foot is stretched out farthest.
constexpr int kPeak = 22;

// How far a strike has come, 0 to 1 and back within half a second.
double Share(double t) {
  const double away = std::abs(t - kPeak / kRate) / 0.25;
  return away < 1 ? 1 - away * away : 0;
}

motion::Poses Punching() {
  return Puppet([](double t, authoring::PuppetPose* pose) {
    pose->right_hand.target = {-0.15, -0.45 + 0.4 * Share(t), 0.1 + 0.45 * Share(t)};
  });
}

motion::Poses Kicking() {
  return Puppet([](double t, authoring::PuppetPose* pose) {
    pose->right_foot.target = {-0.12, kAnkle + 0.7 * Share(t), 0.75 * Share(t)};
  });
}

// Stands opposite, facing the leader.
motion::Poses Opposite(float apart = kApart) {
  return Changed(Puppet(), [apart](int, Vec3 joint) {
    return Vec3{-joint.x, joint.y, apart - joint.z};
  });
}

Meetings Fists(float weight = 1) { return Meetings(kFrames, {0, 0, weight, kNear}); }

Meetings Feet(float weight = 1) { return Meetings(kFrames, {0, 0, 0, 0, 0, weight, kNear}); }

motion::Poses Struck(const motion::Poses& leader, const Meetings& meetings, int settled = 0,
                     motion::Poses follower = Opposite()) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const body::Body body = body::FindBody(skeleton);
  ApproachStrikes(skeleton, body, body::Surface(skeleton, body), leader, meetings, {},
                  {kRate, settled}, &follower);
  return follower;
}

double Missing(const motion::Poses& leader, int joint, const motion::Poses& follower) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const body::Surface surface(skeleton, body::FindBody(skeleton));
  return surface.Distance(leader.at(kPeak, joint), follower[kPeak]);
}

TEST(Strikes, APunchEndsNearTheBody) {
  EXPECT_GT(Missing(Punching(), kRightHand, Opposite()), 0.3);
  EXPECT_NEAR(Missing(Punching(), kRightHand, Struck(Punching(), Fists())), kNear, 0.03);
}

TEST(Strikes, TheBodyComesBeforeAndGoesBackAfterwards) {
  const motion::Poses struck = Struck(Punching(), Fists()), before = Opposite();
  EXPECT_LT(struck.at(kPeak - 3, kTorso).z, before.at(kPeak - 3, kTorso).z - 0.05f);
  EXPECT_LT(Distance(struck.at(0, kTorso), before.at(0, kTorso)), 0.01f);
  EXPECT_LT(Distance(struck.at(kFrames - 1, kTorso), before.at(kFrames - 1, kTorso)), 0.01f);
  EXPECT_LT(LargestStep(struck), 1.1f / kRate);
}

TEST(Strikes, AKickEndsNearTheBody) {
  EXPECT_GT(Missing(Kicking(), kKicker, Opposite()), 0.2);
  EXPECT_NEAR(Missing(Kicking(), kKicker, Struck(Kicking(), Feet())), kNear, 0.03);
}

TEST(Strikes, OnlyTheLimbAndOnlyWhereTheLabelsAskForThem) {
  EXPECT_EQ(Struck(Kicking(), Fists()), Opposite());
  EXPECT_EQ(Struck(Punching(), Feet()), Opposite());
  EXPECT_EQ(Struck(Punching(), Fists(0)), Opposite());
  const double half = Missing(Punching(), kRightHand, Struck(Punching(), Fists(0.5f)));
  EXPECT_GT(half, kNear + 0.05);
  EXPECT_LT(half, Missing(Punching(), kRightHand, Opposite()) - 0.05);
}

TEST(Strikes, OneWhoIsNearDoesNotCome) {
  EXPECT_EQ(Struck(Punching(), Fists(), 0, Opposite(0.55f)), Opposite(0.55f));
}

TEST(Strikes, SettledFramesDoNotChangeAndWhatFollowsIsNotTooFast) {
  const motion::Poses struck = Struck(Punching(), Fists(), kPeak - 2);
  for (int t = 0; t < kPeak - 2; ++t) EXPECT_EQ(struck[t], Opposite()[t]);
  EXPECT_LT(LargestStep(struck), 1.1f / kRate);
  EXPECT_EQ(Struck(Punching(), Fists(), kPeak + 10), Opposite());
}

}  // namespace
}  // namespace duet::cleanup
