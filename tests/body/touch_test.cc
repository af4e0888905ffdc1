#include "model/body/touch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "model/motion/body_part.h"
#include "model/motion/skeleton.h"
#include "tests/support/matchers.h"

namespace duet::body {
namespace {

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

TEST(TouchTest, AnElbowDoesNotCount) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  motion::Poses follower = Stick({1, 0, 0}, 2);
  follower.at(0, skeleton.Find("left_elbow")).x = 0;
  EXPECT_EQ(TouchShare(Stick({}, 2), follower, skeleton, motion::SbuParts()), 0);
}

TEST(TouchTest, MissingLimbsGiveNaN) {
  EXPECT_TRUE(std::isnan(TouchShare(Stick({}, 2), Stick({}, 2), motion::SbuSkeleton(), {})));
}

}  // namespace
}  // namespace duet::body
