#include "model/authoring/keyframes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/authoring/puppet.h"
#include "model/motion/skeleton.h"

namespace duet::authoring {
namespace {

using ::testing::HasSubstr;

std::string ParseError(const std::string& text) {
  const absl::StatusOr<motion::Clip> clip = ParseKeyframes(text, "a.txt");
  EXPECT_EQ(clip.status().code(), absl::StatusCode::kInvalidArgument) << clip.status();
  return std::string(clip.status().message());
}

float BoneLength(const std::vector<motion::Vec3>& pose, const motion::Bone& bone) {
  return Distance(pose[static_cast<size_t>(bone.parent)], pose[static_cast<size_t>(bone.child)]);
}

TEST(Puppet, ReachesItsTargets) {
  PuppetPose pose;
  pose.torso = {0.1, 1.1, 0.2};
  pose.left_foot.target = {0.1, 0.08, 0.3};
  pose.right_foot.target = {-0.1, 0.3, 0.1};
  pose.left_hand.target = {0.2, -0.2, 0.4};
  pose.right_hand.target = {-0.2, -0.5, 0.05};
  const std::vector<motion::Vec3> joints = PosePuppet(pose);
  EXPECT_LT(Distance(joints[11], {0.1f, 0.08f, 0.3f}), 1e-5f);
  EXPECT_LT(Distance(joints[14], {-0.1f, 0.3f, 0.1f}), 1e-5f);
  EXPECT_LT(Distance(joints[5] - joints[1], {0.2f, -0.2f, 0.4f}), 1e-5f);
  EXPECT_LT(Distance(joints[8] - joints[1], {-0.2f, -0.5f, 0.05f}), 1e-5f);
}

TEST(Puppet, KeepsBoneLengthsWhereverTheTargetsAre) {
  PuppetPose rest;
  rest.torso = {0, 1.1, 0};
  rest.left_foot.target = {0.1, 0.08, 0};
  rest.right_foot.target = {-0.1, 0.08, 0};
  const std::vector<motion::Vec3> reference = PosePuppet(rest);
  const std::vector<motion::Bone> bones = motion::SbuSkeleton().bones;
  EXPECT_NEAR(BoneLength(reference, {9, 10}), 0.43, 1e-5);
  EXPECT_NEAR(BoneLength(reference, {4, 5}), 0.28, 1e-5);
  for (const retargeting::Vec3d target :
       {retargeting::Vec3d{0, 0, 0}, {5, 5, 5}, {0.15, -0.01, 0}, {0, 3, 0}, {0, -9, 0}}) {
    PuppetPose pose = rest;
    pose.left_hand.target = pose.right_hand.target = target;
    pose.left_foot.target = pose.right_foot.target = target;
    pose.chest = {70, -30, 20};
    pose.pelvis = {-40, 20, 10};
    pose.left_hand.swivel = 200;
    const std::vector<motion::Vec3> joints = PosePuppet(pose);
    for (const motion::Bone& bone : bones) {
      EXPECT_NEAR(BoneLength(joints, bone), BoneLength(reference, bone), 1e-5)
          << bone.parent << "-" << bone.child;
    }
  }
}

TEST(Puppet, LeansInTheDocumentedDirections) {
  PuppetPose pose;
  pose.torso = {0, 1.1, 0};
  pose.chest.pitch = 20;
  EXPECT_GT(PosePuppet(pose)[1].z, 0.05f) << "forwards";
  pose.chest = {0, 0, 20};
  EXPECT_GT(PosePuppet(pose)[1].x, 0.05f) << "to the left";
  pose.chest = {30, 0, 0};
  EXPECT_GT(PosePuppet(pose)[6].z, 0.05f) << "a yaw to the left takes the right shoulder forwards";
}

TEST(Keyframes, GoesThroughItsKeyPoses) {
  const absl::StatusOr<motion::Clip> clip = ParseKeyframes(
      "frame_rate 20 # slow\nat 0\n torso 0 1.1 0\nat 0.5\n\ttorso 0.1 1.0 0\nat 1\ntorso 0 1.1 "
      "0\n",
      "a.txt");
  ASSERT_TRUE(clip.ok()) << clip.status();
  EXPECT_EQ(clip->frame_rate_hz, 20);
  ASSERT_EQ(clip->frame_count(), 21);
  EXPECT_EQ(clip->joint_names, motion::SbuSkeleton().joint_names);
  EXPECT_NEAR(clip->at(0, 2).y, 1.1, 1e-6);
  EXPECT_NEAR(clip->at(10, 2).x, 0.1, 1e-6);
  EXPECT_NEAR(clip->at(20, 2).x, 0, 1e-6);
  // A track without keys keeps the relaxed stand: feet on the floor.
  EXPECT_EQ(clip->at(0, 11), clip->at(20, 11));
  EXPECT_NEAR(clip->at(10, 14).y, 0.08, 1e-6);
}

TEST(Keyframes, NamesThePlaceOfAnError) {
  EXPECT_THAT(ParseError(""), HasSubstr("a.txt:1: at: expected at least two key poses"));
  EXPECT_THAT(ParseError("at 0\ntorso 0 1 0\n"), HasSubstr("at: expected at least two key poses"));
  EXPECT_THAT(ParseError("at 0\ntail 0 1 0\n"), HasSubstr("such as torso, got \"tail\""));
  EXPECT_THAT(ParseError("at 0\ntorso 0 1\n"),
              HasSubstr("a.txt:2: torso: expected 3 values, got 2"));
  EXPECT_THAT(ParseError("at 0\ntorso 0 x 1\n"),
              HasSubstr("torso: expected a finite number, got \"x\""));
  EXPECT_THAT(ParseError("torso 0 1 0\n"), HasSubstr("expected \"at 0\" first, got torso"));
  EXPECT_THAT(ParseError("at 1\n"), HasSubstr("at: expected 0 first, got 1"));
  EXPECT_THAT(ParseError("at 0\nat 1\nat 1\n"), HasSubstr("a.txt:3: at: expected more than 1"));
  EXPECT_THAT(ParseError("at 0\nat 61\n"), HasSubstr("at most 60"));
  EXPECT_THAT(ParseError("at 0\nleft_knee 1\nleft_knee 2\n"),
              HasSubstr("left_knee: expected one key at 0 s"));
  EXPECT_THAT(ParseError("frame_rate 0\n"), HasSubstr("frame_rate: expected 1 to 240, got 0"));
}

}  // namespace
}  // namespace duet::authoring
