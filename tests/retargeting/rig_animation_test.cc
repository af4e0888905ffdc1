#include "model/retargeting/rig_animation.h"

#include <algorithm>
#include <string>

#include "gtest/gtest.h"
#include "model/base/angle.h"
#include "tests/support/test_motion.h"

namespace duet::retargeting {
namespace {

using test::MakePerson;
using test::PersonOptions;

std::size_t Find(const RigAnimation& animation, const std::string& name) {
  for (std::size_t j = 0; j < animation.rig.joints.size(); ++j) {
    if (animation.rig.joints[j].name == name) return j;
  }
  ADD_FAILURE() << "no " << name;
  return 0;
}

Quaternion World(const RigAnimation& animation, int frame, std::size_t joint) {
  const RigPose& pose = animation.frames[static_cast<size_t>(frame)];
  Quaternion world = pose.rotations[joint];
  for (int j = animation.rig.joints[joint].parent; j >= 0;
       j = animation.rig.joints[static_cast<size_t>(j)].parent) {
    world = pose.rotations[static_cast<size_t>(j)] * world;
  }
  return world;
}

TEST(RigAnimation, TheRestPoseStandsOnTheFloorAtTheOrigin) {
  PersonOptions away;
  away.at = {5, 3, 2};
  const RigAnimation animation = AnimateRig(motion::SbuSkeleton(), MakePerson(away));
  double lowest = 1;
  for (const Vec3d& position : animation.rest_positions) lowest = std::min(lowest, position.y);
  EXPECT_EQ(lowest, 0);
  EXPECT_EQ(animation.rest_positions[0].x, 0);
  EXPECT_GT(animation.rest_positions[Find(animation, "head")].y, 1.2);
}

TEST(RigAnimation, NeighbouringFramesAreOnTheSameSide) {
  PersonOptions turning;
  turning.turn = 14;
  turning.frames = 200;
  const RigAnimation animation = AnimateRig(motion::SbuSkeleton(), MakePerson(turning));
  for (std::size_t frame = 1; frame < animation.frames.size(); ++frame) {
    for (std::size_t j = 0; j < animation.rig.joints.size(); ++j) {
      EXPECT_GT(Dot(animation.frames[frame].rotations[j], animation.frames[frame - 1].rotations[j]),
                0.5);
    }
  }
}

// Somebody who stands with bent knees: the shins lean, the soles do not.
TEST(RigAnimation, AStandingFootIsLevelAndALiftedOneFollowsItsShin) {
  motion::Clip clip = MakePerson();
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const int knee = skeleton.Find("left_knee"), foot = skeleton.Find("left_foot");
  const int hip = skeleton.Find("left_hip"), other = skeleton.Find("right_foot");
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    const motion::Vec3 at = clip.at(frame, hip);
    const bool stands = frame < clip.frame_count() / 2;
    clip.at(frame, knee) = at + motion::Vec3{0, -0.35f, 0.25f};
    clip.at(frame, foot) = {at.x, stands ? 0.1f : 0.5f, at.z};
    clip.at(frame, other).y = 0.1f;
  }
  const RigAnimation animation = AnimateRig(skeleton, clip);
  const std::size_t joint = Find(animation, "left_foot"), shin = Find(animation, "left_knee");
  const int last = clip.frame_count() - 1;
  EXPECT_NEAR(Rotate(World(animation, 0, joint), {0, 0, 1}).y, 0, 1e-6);
  EXPECT_NEAR(Rotate(World(animation, 0, joint), {0, 1, 0}).y, 1, 1e-6);
  EXPECT_LT(Rotate(World(animation, 0, shin), {0, 1, 0}).y, 0.97);
  EXPECT_NEAR(Angle(World(animation, last, joint), World(animation, last, shin)), 0, 1e-6);
}

// A foot that is lifted at once follows its shin within some frames.
TEST(RigAnimation, AFootDoesNotTurnOverInAFrame) {
  motion::Clip clip = MakePerson();
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const int knee = skeleton.Find("left_knee"), foot = skeleton.Find("left_foot");
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    const motion::Vec3 hip = clip.at(frame, skeleton.Find("left_hip"));
    const bool stands = frame < clip.frame_count() / 2;
    clip.at(frame, knee) = hip + motion::Vec3{0, -0.1f, 0.4f};
    clip.at(frame, foot) = {hip.x, stands ? 0.1f : 0.6f, hip.z};
    clip.at(frame, skeleton.Find("right_foot")).y = 0.1f;
  }
  const RigAnimation animation = AnimateRig(skeleton, clip);
  const std::size_t joint = Find(animation, "left_foot"), shin = Find(animation, "left_knee");
  double fastest = 0;
  for (std::size_t frame = 1; frame < animation.frames.size(); ++frame) {
    fastest = std::max(fastest, Angle(animation.frames[frame - 1].rotations[joint],
                                      animation.frames[frame].rotations[joint]));
  }
  EXPECT_GT(fastest * base::kDegreesPerRadian * clip.frame_rate_hz, 600);
  EXPECT_LT(fastest * base::kDegreesPerRadian * clip.frame_rate_hz, 701);
  const int last = clip.frame_count() - 1;
  EXPECT_NEAR(Angle(World(animation, last, joint), World(animation, last, shin)), 0, 1e-6);
}

}  // namespace
}  // namespace duet::retargeting
