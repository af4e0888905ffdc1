#ifndef DUET_MODEL_RETARGETING_RIG_TRANSFER_H_
#define DUET_MODEL_RETARGETING_RIG_TRANSFER_H_

#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/character_rig.h"

namespace duet::retargeting {

// Transfers a clip of any skeleton of a person (FindBodyRoles) to a user's rig with any rest pose,
// names and extra joints. The rig's bones keep their lengths.
//
// - Kabsch's fit over hips, shoulders and trunk rotates pelvis and chest. The spine's joints share
//   the rotation between the two; neck and head share that of the head.
// - Two-bone inverse kinematics places feet and hands at the clip's ankles and wrists, as far as
//   the limbs reach, with elbows and knees on the clip's side. The pelvis height follows from the
//   length of the rig's legs; the pelvis is lowered if a leg would not reach.
// - The plane of the elbow or knee twists both bones of a limb. Standing feet are level.
// - If the clip has toes, feet point at them, and the rig's toes stay level on the floor while a
//   heel is up. If it has hands beyond the wrists, hands point at them; otherwise they keep their
//   rotation relative to the forearm.
// - Collar bones, fingers and all other joints keep their rest pose relative to their parents.
//
// Requires a rig whose joints map to the clip's. Shapes: returns [frames].
// Errors: INVALID_ARGUMENT naming `source` for a rig that lacks its own hips, knees, feet,
//         shoulders, elbows or hands, or whose limbs have no length; naming the follower if its
//         joints are not those of a person.
absl::StatusOr<std::vector<CharacterPose>> TransferToRig(const motion::Clip& clip,
                                                         const CharacterRig& rig,
                                                         absl::string_view source);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_RIG_TRANSFER_H_
