#include "model/retargeting/joint_names.h"

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

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

// The names of a person, with `affix` around each.
std::vector<std::string> Rig(const std::string& prefix, const std::string& suffix) {
  std::vector<std::string> names;
  for (const char* name : {"Hips", "Spine", "Spine1", "Neck", "Head", "LeftArm", "LeftForeArm",
                           "LeftHand", "RightArm", "RightForeArm", "RightHand", "LeftUpLeg",
                           "LeftLeg", "LeftFoot", "RightUpLeg", "RightLeg", "RightFoot"}) {
    names.push_back(prefix + name + suffix);
  }
  return names;
}

TEST(ParseJointNames, RemovesWhatMostNamesShare) {
  const std::vector<ParsedJointName> plain = ParseJointNames(Rig("", ""));
  EXPECT_EQ(plain[11], (ParsedJointName{BodySide::kLeft, "upleg"}));
  for (const auto& [prefix, suffix] : {std::pair<const char*, const char*>{"CC_Base_", ""},
                                       {"Bob_", ""},
                                       {"Char01_", ""},
                                       {"Take001:Skeleton1_", ""},
                                       {"", "_JNT"},
                                       {"", "_jnt"},
                                       {"", ".001"},
                                       {"My_", "_jnt_01"},
                                       {"bob", ""}}) {
    EXPECT_EQ(ParseJointNames(Rig(prefix, suffix)), plain) << prefix << "*" << suffix;
  }
}

// Programs that write glTF number all nodes.
TEST(ParseJointNames, RemovesRunningNumbers) {
  const std::vector<ParsedJointName> plain = ParseJointNames(Rig("", ""));
  for (const char* prefix : {"mixamorig:", "Bob_", ""}) {
    std::vector<std::string> names = Rig(prefix, "");
    for (std::size_t i = 0; i < names.size(); ++i) {
      names[i] += (i < 10 ? "_0" : "_") + std::to_string(i);
    }
    names.push_back("_rootJoint");
    std::vector<ParsedJointName> parsed = ParseJointNames(names);
    parsed.pop_back();
    EXPECT_EQ(parsed, plain) << prefix;
  }
  // Numbers that tell the joints of a spine apart are no running numbers.
  std::vector<std::string> names = Rig("", "");
  for (const char* name : {"spine_01", "spine_02", "spine_03", "thumb_01", "thumb_02"}) {
    names.emplace_back(name);
  }
  EXPECT_EQ(ParseJointNames(names)[17], (ParsedJointName{BodySide::kMiddle, "spine01"}));
}

TEST(ParseJointNames, EndsAndHelpersNeedNotShareIt) {
  std::vector<std::string> names = Rig("", "_jnt");
  names.push_back("HeadTop_End");
  names.push_back("Head_jnt.end");
  names.push_back("jnt");
  const std::vector<ParsedJointName> parsed = ParseJointNames(names);
  EXPECT_EQ(parsed[4], (ParsedJointName{BodySide::kMiddle, "head"}));
  EXPECT_EQ(parsed[17], (ParsedJointName{BodySide::kMiddle, "headtopend"}));
  EXPECT_EQ(parsed[18], (ParsedJointName{BodySide::kMiddle, "headend"}));
  EXPECT_EQ(parsed[19], (ParsedJointName{BodySide::kMiddle, "jnt"})) << "never empty";
}

TEST(ParseJointNames, KeepsWhatTellsNamesApart) {
  std::vector<std::string> names = Rig("Bob_", "");
  names.push_back("Hips");
  EXPECT_EQ(ParseJointNames(names)[0], (ParsedJointName{BodySide::kMiddle, "bobhips"}));
  // A side is no prefix, and a few names share words by chance.
  const std::vector<std::string> arm = {"left_arm", "left_hand", "left_elbow"};
  EXPECT_EQ(ParseJointNames(arm)[0], (ParsedJointName{BodySide::kLeft, "arm"}));
  EXPECT_EQ(ParseJointNames({"mid_arm", "mid_leg"})[0], ParseJointName("mid_arm"));
}

}  // namespace
}  // namespace duet::retargeting
