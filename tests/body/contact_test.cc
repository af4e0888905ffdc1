#include "model/body/contact.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/motion/body_part.h"
#include "model/motion/skeleton.h"
#include "tests/support/bodies.h"
#include "tests/support/matchers.h"

namespace duet::body {
namespace {

using motion::Vec3;

constexpr int kTorso = 2, kLeftHand = 5, kRightHand = 8;

// A person who stretches the right hand out to +z, and one who stands opposite.
motion::Poses Offering() {
  return test::Puppet([](double, test::PuppetPose* pose) {
    pose->right_hand.target = {-0.15, 0, 0.7};
  });
}

motion::Poses Opposite() {
  return test::Changed(test::Puppet(), [](int, Vec3 joint) {
    return Vec3{-joint.x, joint.y, 1.2f - joint.z};
  });
}

std::optional<double> Apart(const motion::Poses& leader, const motion::Poses& follower) {
  return OfferedHandDistance(FindBody(motion::SbuSkeleton()), kTorso, leader[0], follower[0]);
}

TEST(OfferedHandDistance, IsAbsentWhileHandsHang) {
  EXPECT_FALSE(Apart(test::Puppet(), Opposite()).has_value());
}

TEST(OfferedHandDistance, IsThatOfTheNearestHands) {
  const motion::Poses leader = Offering();
  motion::Poses follower = Opposite();
  follower.at(0, kLeftHand) = leader.at(0, kRightHand) + Vec3{0, 0.2f, 0};
  EXPECT_NEAR(Apart(leader, follower).value_or(9), 0.2, 1e-6);
  follower.at(0, kRightHand) = leader.at(0, kRightHand) + Vec3{0.1f, 0, 0};
  EXPECT_NEAR(Apart(leader, follower).value_or(9), 0.1, 1e-6);
}

TEST(OfferedHandDistance, AHandThatHangsDoesNotCount) {
  const motion::Poses leader = Offering();
  motion::Poses follower = Opposite();
  follower.at(0, kLeftHand) = leader.at(0, kLeftHand);
  EXPECT_GT(Apart(leader, follower).value_or(0), 0.2);
}

TEST(PenetrationTest, MeasuresDepthAndFrequency) {
  motion::Skeleton skeleton;
  skeleton.joint_names = {"a", "b"};
  skeleton.bones = {{0, 1}};
  const std::vector<motion::BodyPart> parts = {{"left_arm", {0, 1}}};
  // Parallel bones (radius 0.045 each) at 1 m, 0.05 m, 0.08 m and exactly touching at 0.09 m or
  // more.
  motion::Poses leader(0, 2), follower(0, 2);
  for (const float distance : {1.0f, 0.05f, 0.08f, 0.1f}) {
    leader.Append({{0, 0, 0}, {0, 1, 0}});
    follower.Append({{distance, 0, 0}, {distance, 1, 0}});
  }
  const Penetration penetration = MeasurePenetration(leader, follower, skeleton, parts);
  EXPECT_DOUBLE_EQ(penetration.frequency, 0.5);
  EXPECT_NEAR(penetration.max_depth_metres, 0.04, 1e-6);
  EXPECT_NEAR(penetration.mean_depth_metres, 0.025, 1e-6);
}

TEST(PenetrationTest, IsZeroForBodiesApart) {
  const motion::Poses leader(15, std::vector<motion::Vec3>(15, {0, 0, 0}));
  const motion::Poses follower(15, std::vector<motion::Vec3>(15, {1, 0, 0}));
  const Penetration penetration =
      MeasurePenetration(leader, follower, motion::SbuSkeleton(), motion::SbuParts());
  EXPECT_EQ(penetration.frequency, 0);
  EXPECT_EQ(penetration.mean_depth_metres, 0);
  EXPECT_EQ(penetration.max_depth_metres, 0);
}

// Everyone's joints along a line up from a place: a body that is a stick 1.4 m high.
motion::Poses Stick(motion::Vec3 at, int frames) {
  motion::Poses poses(frames, motion::SbuSkeleton().joint_count());
  for (int t = 0; t < frames; ++t) {
    for (int j = 0; j < poses.joint_count(); ++j) {
      poses.at(t, j) = at + motion::Vec3{0, 0.1f * static_cast<float>(j), 0};
    }
  }
  return poses;
}

TEST(TouchTest, HandsAndFeetEndTheLimbs) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  EXPECT_THAT(LimbEnds(skeleton, motion::SbuParts()),
              UnorderedElementsAre(skeleton.Find("left_hand"), skeleton.Find("right_hand"),
                                   skeleton.Find("left_foot"), skeleton.Find("right_foot")));
}

TEST(TouchTest, CountsFramesWithAHandNearTheLeader) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const motion::Poses leader = Stick({}, 4);
  motion::Poses follower = Stick({1, 0, 0}, 4);
  EXPECT_EQ(TouchShare(leader, follower, skeleton, motion::SbuParts()), 0);
  follower.at(2, skeleton.Find("right_hand")).x = 0.1f;
  EXPECT_NEAR(TouchShare(leader, follower, skeleton, motion::SbuParts()), 0.25, 1e-6);
  // Beyond every bone's radius (0.11 at most) and the 5 cm.
  follower.at(2, skeleton.Find("right_hand")).x = 0.17f;
  EXPECT_EQ(TouchShare(leader, follower, skeleton, motion::SbuParts()), 0);
}

TEST(TouchTest, MissingLimbsGiveNaN) {
  EXPECT_TRUE(std::isnan(TouchShare(Stick({}, 2), Stick({}, 2), motion::SbuSkeleton(), {})));
}

}  // namespace
}  // namespace duet::body
