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

// Programs that write glTF number all nodes.
TEST(ParseJointNames, RemovesRunningNumbers) {
  const std::vector<ParsedJointName> plain = ParseJointNames(Rig("", ""));
  for (const char* prefix : {"mixamorig:", "CC_Base_", ""}) {
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

}  // namespace
}  // namespace duet::retargeting
