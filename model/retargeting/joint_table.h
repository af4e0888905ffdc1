#ifndef DUET_MODEL_RETARGETING_JOINT_TABLE_H_
#define DUET_MODEL_RETARGETING_JOINT_TABLE_H_

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/retargeting/joint_mapping.h"

namespace duet::retargeting {

// Parses a user's table of joints, one per line:
//
//   # model joint = joint of the file
//   left_hand = LeftWrist
//   torso = Chest 3
//
// '#' at the beginning of a line starts a comment; white space around names is ignored.
//
// Errors: INVALID_ARGUMENT "source:line: ..." for any other line or a repeated joint.
absl::StatusOr<JointOverrides> ParseJointTable(absl::string_view text, absl::string_view source);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_JOINT_TABLE_H_
