#ifndef DUET_MODEL_FORMATS_FLAT_JSON_MOTION_H_
#define DUET_MODEL_FORMATS_FLAT_JSON_MOTION_H_

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/joint_rotations.h"
#include "model/motion/recorded_motion.h"
#include "model/motion/skeleton.h"

namespace duet::formats::flat {

// One JSON document:
//
//   {"format": "duet-motion", "version": 1, "frame_rate_hz": 30, "unit": "metres",
//    "up_axis": "y-up",
//    "joint_names": ["head", ...], "bones": [[1, 0], ...],
//    "leader": [[[x, y, z], ... joints], ... frames], "follower": [...]}
//
// To read it, joint_names and leader are required and follower is optional. The other fields have
// the same defaults as in CSV. Unknown fields are ignored. bones (parent and child as indices into
// joint_names) are for other programs.
//
// Errors: INVALID_ARGUMENT naming `source`, the field, the expected value and the actual one.
absl::StatusOr<motion::RecordedMotion> ParseJsonMotion(absl::string_view text,
                                                       absl::string_view source);

// Writes metres, y up. Requires one person, or a leader and a follower, whom CheckPeople accepts.
//
// `rotations` of the follower may be null; they add the fields
//   "rig": [{"name": "torso", "parent": -1, "offset": [x, y, z], "joint": 2}, ...],
//   "rotations": [[[x, y, z, w], ... rig joints], ... frames]
// with the meaning of docs/rotations.md. ParseJsonMotion ignores them.
std::string FormatJsonMotion(const std::vector<motion::Clip>& people,
                             const motion::Skeleton& skeleton,
                             const motion::JointRotations* rotations = nullptr);

}  // namespace duet::formats::flat

#endif  // DUET_MODEL_FORMATS_FLAT_JSON_MOTION_H_
