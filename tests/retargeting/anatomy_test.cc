#include "model/retargeting/anatomy.h"

#include <gmock/gmock.h>

#include "tests/support/matchers.h"

namespace duet::retargeting {
namespace {

// Mixamo's names, with collar bones, fingers and toes.
motion::Skeleton MixamoSkeleton() {
  motion::Skeleton skeleton;
  skeleton.joint_names = {"Hips",     "Spine",     "LeftShoulder", "LeftArm",    "LeftForeArm",
                          "LeftHand", "LeftThumb", "RightArm",     "RightHand",  "LeftUpLeg",
                          "LeftLeg",  "LeftFoot",  "LeftToeBase",  "RightUpLeg", "RightFoot"};
  skeleton.bones = {{0, 1}, {1, 2}, {2, 3},  {3, 4},   {4, 5},   {5, 6},  {1, 7},
                    {7, 8}, {0, 9}, {9, 10}, {10, 11}, {11, 12}, {0, 13}, {13, 14}};
  return skeleton;
}

TEST(FindAnatomyTest, FindsThePartsOfTheKinectSkeleton) {
  motion::Skeleton skeleton = motion::SbuSkeleton();
  const absl::StatusOr<Anatomy> anatomy = FindAnatomy(skeleton);
  ASSERT_THAT(anatomy, IsOk());
  EXPECT_EQ(anatomy->parts, motion::SbuParts());
  EXPECT_EQ(anatomy->hips, *skeleton.hips);
  EXPECT_EQ(anatomy->feet, *skeleton.feet);
  EXPECT_EQ(anatomy->hands, (motion::JointPair{5, 8}));
}

TEST(FindAnatomyTest, CollarBonesAreTrunkAndToesAreLeg) {
  const absl::StatusOr<Anatomy> anatomy = FindAnatomy(MixamoSkeleton());
  ASSERT_THAT(anatomy, IsOk());
  ASSERT_EQ(anatomy->parts.size(), 5u);
  EXPECT_THAT(anatomy->parts[0].joints, ElementsAre(3, 4, 5, 6));
  EXPECT_THAT(anatomy->parts[2].joints, ElementsAre(9, 10, 11, 12));
  EXPECT_EQ(anatomy->parts[4].name, "trunk");
  EXPECT_THAT(anatomy->parts[4].joints, ElementsAre(0, 1, 2));
  EXPECT_EQ(anatomy->feet, (motion::JointPair{11, 14}));
  EXPECT_THAT(anatomy->notes, ElementsAre("left_hip, right_hip: LeftUpLeg, RightUpLeg",
                                          "left_foot, right_foot: LeftFoot, RightFoot",
                                          "left_shoulder, right_shoulder: LeftArm, RightArm",
                                          HasSubstr("trunk Hips, Spine, LeftShoulder")));
}

TEST(FindAnatomyTest, UsesTheEndOfTheArmAsAnUnnamedHand) {
  motion::Skeleton skeleton = MixamoSkeleton();
  skeleton.joint_names[8] = "tip";
  const absl::StatusOr<Anatomy> anatomy = FindAnatomy(skeleton);
  ASSERT_THAT(anatomy, IsOk());
  EXPECT_EQ(anatomy->hands, (motion::JointPair{6, 8}));
}

TEST(FindAnatomyTest, ReportsRolesWithoutAJoint) {
  motion::Skeleton skeleton = MixamoSkeleton();
  skeleton.joint_names[7] = "wing";
  EXPECT_THAT(FindAnatomy(skeleton),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       AllOf(HasSubstr("left and right shoulder"), HasSubstr("wing"))));
}

TEST(CounterpartJointsTest, AreFoundByTheSideInTheName) {
  EXPECT_THAT(CounterpartJoints({"Hips", "LeftUpLeg", "RightUpLeg", "arm.L", "arm.R", "left_toe"}),
              ElementsAre(0, 2, 1, 4, 3, 5));
}

}  // namespace
}  // namespace duet::retargeting
