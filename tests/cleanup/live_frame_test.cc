#include "model/cleanup/live_frame.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/base/angle.h"
#include "model/motion/limb_lengths.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

const motion::Skeleton kSkeleton = motion::SbuSkeleton();
constexpr int kLeftFoot = 11, kRightFoot = 14;

// A standing puppet that is turned about its vertical axis.
motion::Poses Turned(double degrees) {
  motion::Poses poses = Puppet({}, 1);
  for (Vec3& joint : poses[0]) joint = RotateY(joint, degrees * base::kRadiansPerDegree);
  return poses;
}

// The frame halfway between two, before and after its bones have their lengths.
struct Halfway {
  Halfway(const motion::Poses& before, const motion::Poses& after)
      : interpolated(1, before.joint_count()), pose(1, before.joint_count()) {
    for (int j = 0; j < before.joint_count(); ++j) {
      interpolated.at(0, j) = Lerp(before.at(0, j), after.at(0, j), 0.5f);
    }
    pose = interpolated;
    SetBoneLengths(kSkeleton, MedianBoneLengths(kSkeleton, before), &pose);
  }
  motion::Poses interpolated, pose;
};

void Place(const motion::Poses& before, const motion::Poses& after,
           const motion::Poses& interpolated, motion::Poses* pose) {
  PlaceFeetBetween(kSkeleton, body::FindBody(kSkeleton), before[0], after[0], interpolated[0],
                   (*pose)[0]);
}

float LowerFoot(const motion::Poses& pose) {
  return std::min(pose.at(0, kLeftFoot).y, pose.at(0, kRightFoot).y);
}

TEST(LiveFrameTest, FeetOfABodyThatTurnsAroundStayOnTheFloor) {
  for (const double degrees : {120.0, 150.0, 170.0}) {
    const motion::Poses before = Turned(0), after = Turned(degrees);
    Halfway halfway(before, after);
    EXPECT_LT(LowerFoot(halfway.pose), kAnkle - 0.03) << degrees;
    const motion::Poses bones = halfway.pose;
    Place(before, after, halfway.interpolated, &halfway.pose);
    EXPECT_NEAR(LowerFoot(halfway.pose), kAnkle, 1e-3) << degrees;
    EXPECT_LT(LargestLengthChange(halfway.pose, bones), 1e-4f);
  }
}

TEST(LiveFrameTest, AFootDoesNotGoBeyondTheHeightsOfItsPlannedFrames) {
  const motion::Poses before = Moved(Puppet({}, 1), {0, 0.02f, 0}), after = Puppet({}, 1);
  for (const float beyond : {-0.05f, 0.05f}) {
    motion::Poses pose = Moved(after, {0, beyond, 0});  // a spline that overshoots
    Place(before, after, pose, &pose);
    EXPECT_NEAR(LowerFoot(pose), kAnkle + (beyond > 0 ? 0.02 : 0), 1e-3) << beyond;
  }
}

TEST(LiveFrameTest, AFrameWhoseFeetAreInPlaceKeepsItsPose) {
  const motion::Poses standing = Puppet({}, 1);
  motion::Poses pose = standing;
  Place(standing, standing, standing, &pose);
  EXPECT_EQ(pose, standing);
}

TEST(LiveFrameTest, ABodyWhoseLegsWereHeldBackComesBackToItsHeight) {
  const body::Body body = body::FindBody(kSkeleton);
  motion::Poses pose = Turned(0);
  const float height = HeightOf(body, pose[0]);
  EXPECT_EQ(height, LowerFoot(pose));
  const motion::Poses before = pose;
  KeepHeight(body, height, pose[0]);
  EXPECT_EQ(pose, before);
  pose.at(0, kLeftFoot).y += 0.1f;
  pose.at(0, kRightFoot).y += 0.08f;
  KeepHeight(body, height, pose[0]);
  EXPECT_NEAR(LowerFoot(pose), height, 1e-6);
  EXPECT_NEAR(pose.at(0, kSkeleton.root).y, before.at(0, kSkeleton.root).y - 0.08f, 1e-6);
}

TEST(LiveFrameTest, AFollowerInItsLeaderIsMovedAway) {
  const motion::Poses leader = Puppet({}, 1);
  for (const Vec3 offset : {Vec3{0, 0, 0}, Vec3{0.1f, 0, 0}, Vec3{-0.03f, 0.2f, 0.04f}}) {
    motion::Poses follower = Moved(leader, offset);
    KeepApart(kSkeleton.root, leader[0], follower[0]);
    const Vec3 apart = follower.at(0, kSkeleton.root) - leader.at(0, kSkeleton.root);
    EXPECT_NEAR(std::hypot(apart.x, apart.z), 0.17, 1e-5);
    EXPECT_NEAR(apart.y, offset.y, 1e-6f) << "along the floor";
    EXPECT_GE(apart.x * offset.x + apart.z * offset.z, 0) << "on its own side";
    EXPECT_LT(LargestLengthChange(follower, leader), 1e-5f);
  }
}

TEST(LiveFrameTest, AFollowerBesideItsLeaderStays) {
  const motion::Poses leader = Puppet({}, 1), beside = Moved(leader, {0.12f, 0, 0.13f});
  motion::Poses follower = beside;
  KeepApart(kSkeleton.root, leader[0], follower[0]);
  EXPECT_EQ(follower, beside);
}

}  // namespace
}  // namespace duet::cleanup
