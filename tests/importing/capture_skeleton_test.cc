#include <gmock/gmock.h>

#include "absl/strings/str_replace.h"
#include "model/formats/motion_file.h"
#include "model/importing/steps.h"
#include "tests/importing/bvh_people.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::importing {
namespace {

using test::TemporaryFolder;
using test::WriteTestFile;

class FindSkeletonTest : public ::testing::Test {
 protected:
  absl::StatusOr<CaptureSkeleton> Find(const std::string& name, const std::string& text) {
    WriteTestFile(folder_ / name, text);
    return FindSkeleton(folder_ / name, specified_);
  }

  TemporaryFolder folder_;
  std::string specified_;
};

TEST_F(FindSkeletonTest, ReadsTheHierarchyOfABvhWithDuetsNames) {
  BvhPerson person;
  person.prefix = "mixamorig:";
  const absl::StatusOr<CaptureSkeleton> found = Find("kick.bvh", BvhText(person));
  ASSERT_THAT(found, IsOk());
  EXPECT_THAT(found->skeleton.joint_names,
              ElementsAre("hips", "spine", "spine1", "chest", "neck", "head", "left_arm",
                          "left_forearm", "left_hand", "right_arm", "right_forearm", "right_hand",
                          "left_hip", "left_leg", "left_foot", "left_toebase", "right_hip",
                          "right_leg", "right_foot", "right_toebase"));
  EXPECT_EQ(found->skeleton.root, 0);
  EXPECT_EQ(found->skeleton.hips, (motion::JointPair{12, 16}));
  EXPECT_EQ(found->skeleton.feet, (motion::JointPair{14, 18}));
  EXPECT_EQ(found->hands, (motion::JointPair{8, 11}));
  EXPECT_EQ(found->parts.size(), 5u);
  EXPECT_EQ(found->skeleton.bones[5], (motion::Bone{3, 6}));
}

// Duet's own files have a helper beside every joint of several children.
TEST_F(FindSkeletonTest, OmitsJointsAtTheirParents) {
  motion::ClipPair pair = {test::MakePerson(), test::MakePerson()};
  ASSERT_THAT(formats::WritePair(folder_ / "pair.bvh", pair, motion::SbuSkeleton()), IsOk());
  const absl::StatusOr<CaptureSkeleton> found =
      FindSkeleton(folder_ / "pair.leader.bvh", specified_);
  ASSERT_THAT(found, IsOk());
  EXPECT_EQ(found->skeleton.joint_count(), 15);
  EXPECT_EQ(found->skeleton.joint_names[static_cast<std::size_t>(found->skeleton.root)], "torso");
  EXPECT_EQ(found->skeleton.Parents()[static_cast<std::size_t>(found->skeleton.Find("head"))],
            found->skeleton.Find("neck"));
}

TEST_F(FindSkeletonTest, OmitsFingers) {
  const std::string fingers = absl::StrReplaceAll(
      BvhText({}), {{"JOINT LeftHand\n{\nOFFSET 26 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
                     "End Site\n",
                     "JOINT LeftHand\n{\nOFFSET 26 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
                     "JOINT LeftThumb\n{\nOFFSET 3 0 0\nCHANNELS 0\nEnd Site\n{\nOFFSET 1 0 0\n}\n"
                     "}\nEnd Site\n"}});
  ASSERT_NE(fingers, BvhText({}));
  const absl::StatusOr<CaptureSkeleton> found = Find("kick.bvh", fingers);
  ASSERT_THAT(found, IsOk());
  EXPECT_EQ(found->skeleton.joint_count(), 20);
  EXPECT_THAT(found->notes, Contains("left out: 1 joints of fingers and face"));
}

TEST_F(FindSkeletonTest, NamesWhatIsMissing) {
  const std::string armless =
      absl::StrReplaceAll(BvhText({}), {{"RightArm", "Wing"}, {"LeftArm", "OtherWing"}});
  EXPECT_THAT(Find("kick.bvh", armless),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       AllOf(HasSubstr("kick.bvh: no joint's name says left and right shoulder"),
                             HasSubstr("--skeleton"))));
}

TEST_F(FindSkeletonTest, SpecifiedSkeletonsOverrideTheFile) {
  specified_ = "sbu";
  EXPECT_EQ(Find("kick.bvh", BvhText({}))->skeleton.joint_names, motion::SbuSkeleton().joint_names);
  specified_ = (folder_ / "skeleton.json").string();
  WriteTestFile(specified_, R"({
      "joint_names": ["Hips", "LeftUpLeg", "LeftFoot", "RightUpLeg", "RightFoot", "LeftArm",
                      "RightArm"],
      "bones": [["Hips", "LeftUpLeg"], ["LeftUpLeg", "LeftFoot"], ["Hips", "RightUpLeg"],
                ["RightUpLeg", "RightFoot"], ["Hips", "LeftArm"], ["Hips", "RightArm"]]})");
  const absl::StatusOr<CaptureSkeleton> found = Find("kick.bvh", BvhText({}));
  ASSERT_THAT(found, IsOk());
  EXPECT_EQ(found->skeleton.joint_count(), 7);
  EXPECT_EQ(found->parts.size(), 5u);
}

}  // namespace
}  // namespace duet::importing
