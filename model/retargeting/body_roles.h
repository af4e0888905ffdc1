#ifndef DUET_MODEL_RETARGETING_BODY_ROLES_H_
#define DUET_MODEL_RETARGETING_BODY_ROLES_H_

#include <optional>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/joint_mapping.h"

namespace duet::retargeting {

// The joints of a clip in their roles, for any skeleton whose joints are named as in
// docs/formats.md. "left_hand" and "left_foot" of the body are the wrist and the ankle.
struct BodyRoles {
  JointMap body;  // motion::SbuSkeleton's joints from those of the clip
  // Joints beyond the ankles and beyond the wrists; a skeleton may lack them.
  std::optional<motion::JointPair> toes, hands;
};

// Errors: INVALID_ARGUMENT naming `field` and the joints that no name gives.
absl::StatusOr<BodyRoles> FindBodyRoles(absl::string_view field, const motion::Clip& clip);

// Maps through two maps: `first` gives the joints that `second` reads.
JointMap Compose(const JointMap& first, const JointMap& second);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_BODY_ROLES_H_
