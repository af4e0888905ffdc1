#include "model/body/hands.h"

#include "gtest/gtest.h"
#include "tests/support/bodies.h"

namespace duet::body {
namespace {

using motion::Vec3;

constexpr int kTorso = 2, kLeftHand = 5, kRightHand = 8;

// A person who stretches the right hand out to +z, and one who stands opposite.
motion::Poses Offering() {
  return test::Puppet([](double, authoring::PuppetPose* pose) {
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

}  // namespace
}  // namespace duet::body
