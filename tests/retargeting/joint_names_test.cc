#include "model/retargeting/joint_names.h"

#include <initializer_list>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::retargeting {
namespace {

struct NameCase {
  const char* name;
  BodySide side;
  const char* base;
};

void ExpectNames(std::initializer_list<NameCase> cases) {
  for (const NameCase& one : cases) {
    const ParsedJointName parsed = ParseJointName(one.name);
    EXPECT_EQ(parsed.side, one.side) << one.name;
    EXPECT_EQ(parsed.base, one.base) << one.name;
  }
}

TEST(ParseJointName, IgnoresCaseAndSeparators) {
  ExpectNames({{"LeftUpLeg", BodySide::kLeft, "upleg"},
               {"LEFT_UP_LEG", BodySide::kLeft, "upleg"},
               {"RIGHT_KNEE", BodySide::kRight, "knee"},
               {"up-leg.L", BodySide::kLeft, "upleg"},
               {"upper_arm.L", BodySide::kLeft, "upperarm"},
               {"left_hand", BodySide::kLeft, "hand"},
               {"thigh_r", BodySide::kRight, "thigh"},
               {"RThigh", BodySide::kRight, "thigh"},
               {"LHipJoint", BodySide::kLeft, "hipjoint"},
               {"rShldr", BodySide::kRight, "shldr"},
               {"Head", BodySide::kMiddle, "head"}});
}

TEST(ParseJointName, IgnoresNamespacesAndPrefixesOfTools) {
  ExpectNames({{"mixamorig:LeftArm", BodySide::kLeft, "arm"},
               {"mixamorig1:Spine2", BodySide::kMiddle, "spine2"},
               {"Armature|root|RightFoot", BodySide::kRight, "foot"},
               {"Bip01 L UpperArm", BodySide::kLeft, "upperarm"},
               {"Bip01_R_Calf", BodySide::kRight, "calf"},
               {"DEF-forearm.R", BodySide::kRight, "forearm"},
               {"J_Bip_L_UpperArm", BodySide::kLeft, "upperarm"},
               {"J_Bip_C_Hips", BodySide::kMiddle, "hips"},
               {"root", BodySide::kMiddle, "root"}});  // without another word, it is the name
}

TEST(ParseJointName, FindsASideJoinedToALimb) {
  ExpectNames({{"leftarm", BodySide::kLeft, "arm"},
               {"armright", BodySide::kRight, "arm"},
               {"lfemur", BodySide::kLeft, "femur"},
               {"rhumerus", BodySide::kRight, "humerus"}});
}

TEST(ParseJointName, FindsNoSideInOtherWords) {
  ExpectNames({{"LowerBack", BodySide::kMiddle, "lowerback"},
               {"lowerback", BodySide::kMiddle, "lowerback"},
               {"lhead", BodySide::kMiddle, "lhead"},
               {"leg", BodySide::kMiddle, "leg"},
               {"L", BodySide::kMiddle, "l"},
               {"Left", BodySide::kMiddle, "left"},
               {"", BodySide::kMiddle, ""}});
}

TEST(ParseJointName, UsesTheFirstSide) {
  ExpectNames({{"Left Right Arm", BodySide::kLeft, "rightarm"}});
}

TEST(JointAliases, OfASkeletonsJointAreItsRow) {
  EXPECT_THAT(JointAliases("head"), ElementsAre("head", "skull"));
  EXPECT_THAT(JointAliases("hand"), ElementsAre("wrist", "hand", "handfk", "palm"));
}

TEST(JointAliases, OfAnotherNameAreItselfAndTheRowsWithIt) {
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
