#include "model/motion/skeleton.h"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::motion {
namespace {

TEST(SbuSkeleton, IsValid) { EXPECT_THAT(Validate(SbuSkeleton()), IsOk()); }

TEST(SbuSkeleton, HasThePapersBones) {
  // Section 3.4, 1-based and without direction.
  const std::pair<int, int> paper[] = {{1, 2},   {2, 3},   {2, 4},   {2, 7},  {3, 10},
                                       {3, 13},  {4, 5},   {5, 6},   {7, 8},  {8, 9},
                                       {10, 11}, {11, 12}, {13, 14}, {14, 15}};
  const Skeleton skeleton = SbuSkeleton();
  EXPECT_EQ(skeleton.bones.size(), 14u);
  for (const auto& [a, b] : paper) {
    EXPECT_THAT(skeleton.bones, ::testing::AnyOf(::testing::Contains(Bone{a - 1, b - 1}),
                                                 ::testing::Contains(Bone{b - 1, a - 1})))
        << a << "-" << b;
  }
}

TEST(SbuSkeleton, LandmarksAreWhatTheyAreCalled) {
  const Skeleton skeleton = SbuSkeleton();
  EXPECT_EQ(skeleton.root, skeleton.Find("torso"));
  EXPECT_EQ(skeleton.hips, (JointPair{skeleton.Find("left_hip"), skeleton.Find("right_hip")}));
  EXPECT_EQ(skeleton.feet, (JointPair{skeleton.Find("left_foot"), skeleton.Find("right_foot")}));
}

TEST(Skeleton, FindsJointsByName) {
  EXPECT_EQ(SbuSkeleton().Find("head"), 0);
  EXPECT_EQ(SbuSkeleton().Find("right_foot"), 14);
  EXPECT_EQ(SbuSkeleton().Find("tail"), -1);
  EXPECT_EQ(SbuSkeleton().Find(""), -1);
}

TEST(Skeleton, HandsAreTheWristsIfItHasThem) {
  Skeleton skeleton = SbuSkeleton();
  EXPECT_EQ(FindHands(skeleton), (JointPair{5, 8}));
  skeleton.joint_names[1] = "left_wrist";
  EXPECT_EQ(FindHands(skeleton), (JointPair{5, 8}));  // one wrist is no pair
  skeleton.joint_names[2] = "right_wrist";
  EXPECT_EQ(FindHands(skeleton), (JointPair{1, 2}));
  skeleton.joint_names[1] = skeleton.joint_names[2] = skeleton.joint_names[5] = "other";
  EXPECT_FALSE(FindHands(skeleton).has_value());
}

TEST(Skeleton, KnowsParents) {
  EXPECT_THAT(SbuSkeleton().Parents(),
              ::testing::ElementsAre(1, 2, -1, 1, 3, 4, 1, 6, 7, 2, 9, 10, 2, 12, 13));
}

struct Broken {
  const char* what;
  std::function<void(Skeleton&)> how;
  const char* why;
};

class BrokenSkeleton : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenSkeleton, IsRejectedByField) {
  Skeleton skeleton = SbuSkeleton();
  GetParam().how(skeleton);
  EXPECT_THAT(Validate(skeleton),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(GetParam().why)));
}

INSTANTIATE_TEST_SUITE_P(
    Skeleton, BrokenSkeleton,
    ::testing::Values(Broken{"no_joints", [](Skeleton& s) { s.joint_names.clear(); },
                             "joint_names: expected at least one joint"},
                      Broken{"unnamed", [](Skeleton& s) { s.joint_names[3] = ""; },
                             "joint_names: expected non-empty names"},
                      Broken{"name_twice", [](Skeleton& s) { s.joint_names[3] = "head"; },
                             "joint_names: \"head\" is repeated"},
                      Broken{"root_high", [](Skeleton& s) { s.root = 15; },
                             "root: expected a joint index from 0 to 14, got 15"},
                      Broken{"root_low", [](Skeleton& s) { s.root = -1; },
                             "root: expected a joint index from 0 to 14, got -1"},
                      Broken{"left_hip", [](Skeleton& s) { s.hips->left = 99; },
                             "left_hip: expected a joint index"},
                      Broken{"right_hip", [](Skeleton& s) { s.hips->right = 99; },
                             "right_hip: expected a joint index"},
                      Broken{"left_foot", [](Skeleton& s) { s.feet->left = 99; },
                             "left_foot: expected a joint index"},
                      Broken{"right_foot", [](Skeleton& s) { s.feet->right = 99; },
                             "right_foot: expected a joint index"},
                      Broken{"bone_missing", [](Skeleton& s) { s.bones.pop_back(); },
                             "bones: expected 14 to connect 15 joints, got 13"},
                      Broken{"bone_more",
                             [](Skeleton& s) {
                               s.bones.push_back({0, 1});
                             },
                             "bones: expected 14 to connect 15 joints, got 15"},
                      Broken{"bone_joint", [](Skeleton& s) { s.bones[0].child = -2; },
                             "bones: expected a joint index from 0 to 14, got -2"},
                      Broken{"two_parents",
                             [](Skeleton& s) {
                               s.bones[0] = {2, 3};
                             },
                             "expected one parent of joint 3, got another"},
                      Broken{"root_has_a_parent",
                             [](Skeleton& s) {
                               s.bones[0] = {0, 2};
                             },
                             "expected no parent of joint 2, got another"},
                      Broken{"bone_to_itself", [](Skeleton& s) { s.bones[6].parent = 4; },
                             "below the root, got it elsewhere"},
                      Broken{"circle_of_two",
                             [](Skeleton& s) {
                               s.bones[2].parent = 4;  // shoulder <- elbow <- shoulder
                             },
                             "below the root, got it elsewhere"}),
    [](const ::testing::TestParamInfo<Broken>& broken) { return broken.param.what; });

TEST(Skeleton, LandmarksMayBeAbsent) {
  Skeleton skeleton = SbuSkeleton();
  skeleton.hips.reset();
  skeleton.feet.reset();
  EXPECT_THAT(Validate(skeleton), IsOk());
}

TEST(Skeleton, TwentyJointsAreAsGood) {
  Skeleton skeleton;
  for (int j = 0; j < 20; ++j) {
    skeleton.joint_names.push_back("joint" + std::to_string(j));
    if (j > 0) skeleton.bones.push_back({(j - 1) / 2, j});
  }
  EXPECT_THAT(Validate(skeleton), IsOk());
}

}  // namespace
}  // namespace duet::motion
