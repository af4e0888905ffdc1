#ifndef DUET_MODEL_RETARGETING_REST_POSE_H_
#define DUET_MODEL_RETARGETING_REST_POSE_H_

#include <optional>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "absl/types/span.h"
#include "model/motion/clip.h"
#include "model/motion/vec3.h"
#include "model/retargeting/character_rig.h"

namespace duet::retargeting {

// Whether a pose is that of a person whose legs hang below the trunk, in any direction of the
// world: the shoulders are on the sides of their hips, and no arm points across the body. In some
// files (LAFAN1, Kimodo) the offsets of all bones point along one axis; only their motion makes a
// person.
//
// Shape: [joints of motion::SbuSkeleton].
bool IsStanding(absl::Span<const motion::Vec3> body);

// Returns the frame of a rig's motion that replaces its rest pose, because the rest pose is no
// standing person: the frame in which the person stands most upright. Absent if the rest pose is a
// standing person, or the motion's joints are not a person's.
//
// `rig` is at rest; `read` is its motion, with the joints that rig.joints gives.
// Errors: INVALID_ARGUMENT naming `source` if there is no such frame either.
absl::StatusOr<std::optional<int>> FindRestFrame(const CharacterRig& rig, const motion::Clip& read,
                                                 absl::string_view source);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_REST_POSE_H_
