#include "model/retargeting/joint_tree.h"

#include "gtest/gtest.h"

namespace duet::retargeting {
namespace {

// root -> pelvis -> two hips with feet; root -> chest -> two shoulders with hands, and a head.
JointTree Figure() {
  return {{"root", "pelvis", "left_hip", "left_foot", "right_hip", "right_foot", "chest",
           "left_shoulder", "left_hand", "right_shoulder", "right_hand", "head"},
          {-1, 0, 1, 2, 1, 4, 0, 6, 7, 6, 9, 6},
          {{5, 5, 5},
           {0, 0, -3},
           {4, 0, 0},
           {0, 0, 40},
           {-4, 0, 0},
           {0, 0, -40},
           {0, 20, 0},
           {8, 6, 0},
           {0, 30, 0},
           {-8, 6, 0},
           {30, 0, 0},
           {0, 0, 10}}};
}

constexpr int kRoot = 0, kPelvis = 1, kLeftHip = 2, kLeftFoot = 3, kRightHip = 4, kChest = 6,
              kLeftShoulder = 7, kLeftHand = 8, kRightShoulder = 9, kRightHand = 10, kHead = 11;

TEST(JointTree, FindsCommonAncestors) {
  const JointTree tree = Figure();
  EXPECT_EQ(CommonAncestor(tree, kLeftFoot, kRightHip), kPelvis);
  EXPECT_EQ(CommonAncestor(tree, kLeftFoot, kHead), kRoot);
  EXPECT_EQ(CommonAncestor(tree, kHead, kChest), kChest);
  EXPECT_EQ(CommonAncestor(tree, kHead, kHead), kHead);
  JointTree two = tree;
  two.parents[kChest] = -1;
  EXPECT_EQ(CommonAncestor(two, kLeftFoot, kHead), -1);
}

TEST(JointTree, FindsAncestorsAndDescendants) {
  const JointTree tree = Figure();
  EXPECT_TRUE(IsAtOrBelow(tree, kHead, kChest));
  EXPECT_TRUE(IsAtOrBelow(tree, kHead, kRoot));
  EXPECT_TRUE(IsAtOrBelow(tree, kChest, kChest));
  EXPECT_FALSE(IsAtOrBelow(tree, kHead, kPelvis));
  EXPECT_FALSE(IsAtOrBelow(tree, kChest, kHead));
}

TEST(PullStraight, StraightensACharacterInAnyRestPose) {
  Landmarks landmarks;
  landmarks.head = kHead;
  landmarks.hips = motion::JointPair{kLeftHip, kRightHip};
  landmarks.shoulders = motion::JointPair{kLeftShoulder, kRightShoulder};
  const std::vector<motion::Vec3> straight = PullStraight(Figure(), landmarks);
  const auto expect = [&straight](int joint, motion::Vec3 at) {
    EXPECT_LT(Distance(straight[static_cast<size_t>(joint)], at), 1e-5f) << joint;
  };
  expect(kRoot, {0, 0, 0});
  expect(kChest, {0, 20, 0});
  expect(kHead, {0, 30, 0});
  expect(kLeftShoulder, {8, 26, 0});
  expect(kLeftHand, {38, 26, 0});
  expect(kRightHand, {-38, 26, 0});
  expect(kLeftHip, {4, -3, 0});
  expect(kRightHip, {-4, -3, 0});
  expect(kLeftFoot, {4, -43, 0});
}

TEST(PullStraight, NeedsNoLandmarks) {
  const std::vector<motion::Vec3> straight = PullStraight(Figure(), {});
  EXPECT_LT(Distance(straight[kHead], {0, 30, 0}), 1e-5f);
  JointTree apart = Figure();
  apart.parents[kRightShoulder] = -1;
  Landmarks landmarks;
  landmarks.shoulders = motion::JointPair{kLeftShoulder, kRightShoulder};
  landmarks.hips = motion::JointPair{kLeftHip, kRightShoulder};
  EXPECT_EQ(PullStraight(apart, landmarks).size(), apart.names.size());
}

}  // namespace
}  // namespace duet::retargeting
