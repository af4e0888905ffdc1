#include "model/motion/body_part.h"

#include "absl/strings/str_cat.h"
#include "model/base/text.h"

namespace duet::motion {

absl::Status Validate(const std::vector<BodyPart>& parts, const Skeleton& skeleton) {
  if (parts.empty()) return absl::InvalidArgumentError("parts: expected at least one, got none");
  for (const BodyPart& part : parts) {
    if (part.joints.empty()) {
      return absl::InvalidArgumentError(absl::StrCat("parts: expected at least one joint of ",
                                                     base::Quoted(part.name), ", got none"));
    }
    for (const int joint : part.joints) {
      absl::Status status = CheckJoint(absl::StrCat("parts.", part.name), joint, skeleton);
      if (!status.ok()) return status;
    }
  }
  return absl::OkStatus();
}

std::vector<BodyPart> SbuParts() {
  return {{"left_arm", {3, 4, 5}},
          {"right_arm", {6, 7, 8}},
          {"left_leg", {9, 10, 11}},
          {"right_leg", {12, 13, 14}},
          {"trunk", {0, 1, 2}}};
}

}  // namespace duet::motion
