#ifndef DUET_MODEL_RETARGETING_BODY_CHECK_H_
#define DUET_MODEL_RETARGETING_BODY_CHECK_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/joint_mapping.h"

namespace duet::retargeting {

// Checks that the joints that were found in a file make a body. `poses` are the skeleton's.
//
// Errors: INVALID_ARGUMENT naming `source` and the file's joints if both hips or both shoulders are
//         in one place in the whole motion: they are helpers with the names of joints.
absl::Status CheckBody(absl::string_view source, const motion::Skeleton& skeleton,
                       const motion::Poses& poses, const JointMap& map,
                       const std::vector<std::string>& file_joints);

// For each bone of a limb that has another length on the other side, a line for people to read.
std::vector<std::string> UnequalBones(const motion::Skeleton& skeleton, const motion::Poses& poses);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_BODY_CHECK_H_
