#include "model/engine/strike_fit.h"

#include "gtest/gtest.h"
#include "tests/cleanup/bodies.h"

namespace duet::engine {
namespace {

using cleanup::kFrames;
using motion::Vec3;

constexpr int kRightHand = 8, kRightFoot = 14;

// A leader with a hand or a foot so far in front of the root.
motion::Poses Reaching(int joint, float ahead, float height) {
  motion::Poses leader = cleanup::Puppet();
  for (int t = 0; t < kFrames; ++t) {
    leader.at(t, joint) = leader.at(t, 2) + Vec3{0, height, ahead};
    leader.at(t, joint - 1) = Lerp(leader.at(t, joint - 2), leader.at(t, joint), 0.5f);
  }
  return leader;
}
motion::Poses Punching() { return Reaching(kRightHand, 0.65f, 0.2f); }
motion::Poses Kicking() { return Reaching(kRightFoot, 0.7f, -0.1f); }

motion::Poses Opposite(float apart) {
  return cleanup::Changed(cleanup::Puppet(), [apart](int, Vec3 joint) {
    return Vec3{-joint.x, joint.y, apart - joint.z};
  });
}

TEST(StrikeFit, FindsTheLimbThatEndsNearTheBody) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  StrikeFit fists(skeleton), feet(skeleton);
  fists.Add(Punching(), Opposite(1), 0, kFrames);
  feet.Add(Kicking(), Opposite(1), 0, kFrames);
  EXPECT_EQ(fists.Limb(), StrikingLimb::kFist);
  EXPECT_EQ(feet.Limb(), StrikingLimb::kFoot);
}

TEST(StrikeFit, ALimbThatStaysFarOrSeldomReachesOutDoesNotStrike) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  StrikeFit far(skeleton), seldom(skeleton), none(skeleton);
  far.Add(Punching(), Opposite(1.6f), 0, kFrames);
  EXPECT_FALSE(far.Limb().has_value());
  seldom.Add(Punching(), Opposite(1), 0, kFrames);
  seldom.Add(cleanup::Puppet(), Opposite(1), 0, kFrames);
  EXPECT_FALSE(seldom.Limb().has_value());
  EXPECT_FALSE(none.Limb().has_value());
}

TEST(StrikeFit, OnlyTheFramesOfTheStretchCount) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  motion::Poses leader = cleanup::Puppet();
  leader.Resize(10);
  const motion::Poses punch = Punching();
  for (int t = 10; t < kFrames; ++t) leader.Append(punch[t]);
  StrikeFit before(skeleton), after(skeleton);
  before.Add(leader, Opposite(1), 0, 10);
  after.Add(leader, Opposite(1), 10, kFrames);
  EXPECT_FALSE(before.Limb().has_value());
  EXPECT_EQ(after.Limb(), StrikingLimb::kFist);
}

}  // namespace
}  // namespace duet::engine
