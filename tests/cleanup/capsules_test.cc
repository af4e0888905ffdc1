#include "model/cleanup/capsules.h"

#include "model/authoring/puppet.h"
#include "model/motion/capsules.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

const motion::Skeleton& Sbu() {
  static const auto* const kSkeleton = new motion::Skeleton(motion::SbuSkeleton());
  return *kSkeleton;
}

motion::Poses Parted(motion::Poses follower, float touch = 0, int settled = 0,
                     const motion::Skeleton& skeleton = Sbu()) {
  const body::Body body = body::FindBody(skeleton);
  const std::vector<double> radii = body::CapsuleRadii(skeleton, body);
  const motion::Poses leader = Puppet();
  const Touch touches(kFrames, touch);
  PartBodies(skeleton, body, radii, leader, touches, {}, {kRate, settled}, &follower);
  PartArms(skeleton, body, radii, leader, touches, {}, {kRate, settled}, &follower);
  return follower;
}

// The deepest overlap with the leader, metres.
double Depth(const motion::Poses& follower, int frame) {
  const std::vector<double> radii = body::CapsuleRadii(Sbu(), body::FindBody(Sbu()));
  const motion::Poses leader = Puppet();
  double deepest = 0;
  for (std::size_t a = 0; a < radii.size(); ++a) {
    for (std::size_t b = 0; b < radii.size(); ++b) {
      const motion::Bone &p = Sbu().bones[a], &q = Sbu().bones[b];
      deepest = std::max(
          deepest,
          radii[a] + radii[b] -
              motion::SegmentDistance(leader.at(frame, p.parent), leader.at(frame, p.child),
                                      follower.at(frame, q.parent), follower.at(frame, q.child)));
    }
  }
  return deepest;
}

// Stands opposite of the leader, arms hanging.
motion::Poses Opposite(float distance) {
  return Changed(Puppet(), [&](int, Vec3 joint) {
    return RotateY(joint, 3.14159265) + Vec3{0, 0, distance};
  });
}

// Stands 60 cm away and reaches through the leader's trunk.
motion::Poses Stabbing() {
  const motion::Poses reaching = Puppet([](double t, authoring::PuppetPose* pose) {
    pose->right_hand.target = {0, -0.15, 0.5 + 0.02 * std::sin(4 * t)};
  });
  return Changed(reaching, [](int, Vec3 joint) {
    return RotateY(joint, 3.14159265) + Vec3{0, 0, 0.55f};
  });
}

TEST(PartBodies, AnOverlappingFollowerMovesAway) {
  const motion::Poses inside = Opposite(0.1f);
  EXPECT_GT(Depth(inside, 20), 0.1);
  const motion::Poses parted = Parted(inside);
  EXPECT_LT(Depth(parted, 20), 0.04);
  EXPECT_LT(LargestLengthChange(parted, inside), 1e-5f);
  EXPECT_EQ(parted.at(20, 2).y, inside.at(20, 2).y);
}

TEST(PartArms, AnArmThatReachesThroughTheLeaderIsMovedOut) {
  const motion::Poses through = Stabbing();
  EXPECT_GT(Depth(through, 20), 0.08);
  const motion::Poses parted = Parted(through);
  EXPECT_LT(Depth(parted, 20), 0.04);
  EXPECT_LT(LargestLengthChange(parted, through), 1e-5f);
  EXPECT_EQ(parted.at(20, 2), through.at(20, 2));  // the arm alone
  EXPECT_LT(LargestStep(parted), 0.05f);
}

TEST(PartBoth, SmallOverlapsAreUnchanged) { EXPECT_EQ(Parted(Opposite(1)), Opposite(1)); }

TEST(PartBoth, AnEmbraceIsUnchanged) {
  EXPECT_EQ(Parted(Opposite(0.3f), 1), Opposite(0.3f));
  EXPECT_EQ(Parted(Stabbing(), 1), Stabbing());
  EXPECT_GT(Depth(Parted(Stabbing(), 0.7f), 20), Depth(Parted(Stabbing()), 20) + 0.02);
}

TEST(PartBodies, HeadsAndTrunksKeepApartAlsoInAnEmbrace) {
  const motion::Poses parted = Parted(Opposite(0.1f), 1);
  const motion::Poses leader = Puppet();
  EXPECT_GT(Distance(parted.at(20, 0), leader.at(20, 0)), 0.19f);
  EXPECT_LT(Distance(parted.at(20, 0), leader.at(20, 0)), 0.3f);
}

TEST(PartBoth, SettledFramesStayAndTheRestFollowsSmoothly) {
  for (const motion::Poses& before : {Opposite(0.1f), Stabbing()}) {
    const motion::Poses parted = Parted(before, 0, 15);
    for (int t = 0; t < 15; ++t) EXPECT_EQ(parted[t], before[t]);
    EXPECT_LT(LargestStep(parted), 0.08f);
    EXPECT_LT(Depth(parted, kFrames - 1), 0.04);
  }
}

TEST(PartBoth, NeedsHips) {
  EXPECT_EQ(Parted(Opposite(0.1f), 0, 0, WithoutHips()), Opposite(0.1f));
}

}  // namespace
}  // namespace duet::cleanup
