#include "model/retargeting/joint_names.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace duet::retargeting {
namespace {

using ::testing::ElementsAre;

void ExpectName(const char* name, BodySide side, const char* base) {
  const ParsedJointName parsed = ParseJointName(name);
  EXPECT_EQ(parsed.side, side) << name;
  EXPECT_EQ(parsed.base, base) << name;
}

TEST(ParseJointName, ReadsWordsHoweverTheyAreWritten) {
  ExpectName("LeftUpLeg", BodySide::kLeft, "upleg");
  ExpectName("LEFT_UP_LEG", BodySide::kLeft, "upleg");
  ExpectName("up-leg.L", BodySide::kLeft, "upleg");
  ExpectName("RThigh", BodySide::kRight, "thigh");
  ExpectName("rShldr", BodySide::kRight, "shldr");
  ExpectName("Head", BodySide::kMiddle, "head");
}

TEST(ParseJointName, LeavesOutNamespacesAndTheToolsOwnWords) {
  ExpectName("mixamorig:LeftArm", BodySide::kLeft, "arm");
  ExpectName("Armature|root|RightFoot", BodySide::kRight, "foot");
  ExpectName("Bip01 L Thigh", BodySide::kLeft, "thigh");
  ExpectName("J_Bip_C_Hips", BodySide::kMiddle, "hips");
  ExpectName("root", BodySide::kMiddle, "root");  // alone it is the name itself
}

TEST(ParseJointName, FindsASideThatIsJoinedToALimb) {
  ExpectName("leftarm", BodySide::kLeft, "arm");
  ExpectName("armright", BodySide::kRight, "arm");
  ExpectName("lfemur", BodySide::kLeft, "femur");
  ExpectName("rhumerus", BodySide::kRight, "humerus");
  ExpectName("lowerback", BodySide::kMiddle, "lowerback");
  ExpectName("lhead", BodySide::kMiddle, "lhead");
}

TEST(ParseJointName, TheFirstWordThatIsASideCounts) {
  ExpectName("Left Right Arm", BodySide::kLeft, "rightarm");
  ExpectName("Left", BodySide::kMiddle, "left");
}

TEST(JointAliases, AreTheRowOfASkeletonsJoint) {
  EXPECT_THAT(JointAliases("head"), ElementsAre("head", "skull"));
  EXPECT_THAT(JointAliases("hand"), ElementsAre("wrist", "hand", "handfk", "palm"));
}

TEST(JointAliases, OfAnotherNameStartWithItselfAndTakeTheRowsThatHaveIt) {
  EXPECT_THAT(JointAliases("wrist"), ElementsAre("wrist", "wrist", "hand", "handfk", "palm"));
  EXPECT_THAT(JointAliases("tail"), ElementsAre("tail"));
}

TEST(JointKinds, SpineAndNeckAreInTheMiddleAndNoEnds) {
  for (const char* name : {"Spine1", "LowerBack", "Chest", "torso", "Abdomen", "thorax", "waist"}) {
    EXPECT_TRUE(IsSpine(ParseJointName(name))) << name;
    EXPECT_FALSE(IsNeck(ParseJointName(name))) << name;
  }
  for (const char* name : {"Neck", "lowerneck", "neck_01"}) {
    EXPECT_TRUE(IsNeck(ParseJointName(name))) << name;
    EXPECT_FALSE(IsSpine(ParseJointName(name))) << name;
  }
  for (const char* name : {"Neck_End", "Spine_End", "LeftNeck", "LeftChest", "Head"}) {
    EXPECT_FALSE(IsSpine(ParseJointName(name))) << name;
    EXPECT_FALSE(IsNeck(ParseJointName(name))) << name;
  }
}

}  // namespace
}  // namespace duet::retargeting
