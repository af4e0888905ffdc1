#ifndef DUET_MODEL_RETARGETING_JOINT_TABLE_H_
#define DUET_MODEL_RETARGETING_JOINT_TABLE_H_

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/retargeting/joint_mapping.h"

namespace duet::retargeting {

// A user's own table of joints, one a line:
//
//   # model joint = joint of the file
//   left_hand = LeftWrist
//   torso = Chest 3
//
// '#' starts a comment at the beginning of a line; blanks around names do not count.
//
// Errors: INVALID_ARGUMENT "source:line: ..." for a line of another kind or a joint that is given
//         twice.
absl::StatusOr<JointOverrides> ParseJointTable(absl::string_view text, absl::string_view source);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_JOINT_TABLE_H_
