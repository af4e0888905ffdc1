#ifndef DUET_MODEL_RETARGETING_JOINT_NAMES_H_
#define DUET_MODEL_RETARGETING_JOINT_NAMES_H_

#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace duet::retargeting {

enum class BodySide { kMiddle, kLeft, kRight };

// What a joint's name says, without prefix, case, separators and side:
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

// Bases under which files have the joint that a skeleton calls `base`, the best first.
std::vector<std::string> JointAliases(const std::string& base);

// Whether a joint may be one of the spine between hips and neck, or one of the neck.
bool IsSpine(const ParsedJointName& name);
bool IsNeck(const ParsedJointName& name);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_JOINT_NAMES_H_
