#ifndef DUET_MODEL_RETARGETING_JOINT_NAMES_H_
#define DUET_MODEL_RETARGETING_JOINT_NAMES_H_

#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace duet::retargeting {

enum class BodySide { kMiddle, kLeft, kRight };

// A joint's name split into its side and its base, which has no prefix, case or separators:
//   mixamorig:LeftUpLeg   left  upleg        Bip01 L Thigh   left  thigh
//   upper_arm.R           right upperarm     rShldr          right shldr
struct ParsedJointName {
  BodySide side = BodySide::kMiddle;
  std::string base;

  friend bool operator==(const ParsedJointName& a, const ParsedJointName& b) {
    return a.side == b.side && a.base == b.base;
  }
};
ParsedJointName ParseJointName(absl::string_view name);
// The names of a file's joints. Words that most of them share as a prefix or suffix are removed
// (CC_Base_Hip, Bob_Hips, hips_JNT, upleg.L.001), unless names that differ would then be the same.
// So are running numbers at the end of most names (mixamorig:LeftArm_08).
std::vector<ParsedJointName> ParseJointNames(const std::vector<std::string>& names);

// The bases that files use for the joint that a skeleton calls `base`, in order of preference.
std::vector<std::string> JointAliases(const std::string& base);

// Whether the name is that of a joint of the spine between hips and neck, or of the neck.
bool IsSpine(const ParsedJointName& name);
bool IsNeck(const ParsedJointName& name);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_JOINT_NAMES_H_
