#ifndef DUET_MODEL_RETARGETING_RIG_TRANSFER_H_
#define DUET_MODEL_RETARGETING_RIG_TRANSFER_H_

#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/character_rig.h"

namespace duet::retargeting {

// A clip of the skeleton's joints on somebody else's rig, whatever its rest pose, names and extra
// joints: the rig's bones keep their lengths.
//
// - Pelvis and chest turn by Kabsch's fit over hips, shoulders and trunk; the spine's joints share
//   the turn between the two, and neck and head the head's.
// - Feet and hands stand where the clip has ankles and wrists, where the limbs reach so far: by
//   two-bone inverse kinematics with elbows and knees on the clip's side. The pelvis comes down
//   where a leg would not reach, and goes up or down with the length of the rig's legs.
// - The plane of elbow or knee twists both bones of a limb; hands keep their turn on the forearm;
// feet
//   are level where they stand. Collar bones, fingers, toes and all else stay at rest on their
//   parents.
//
// Requires motion::SbuSkeleton's joints. Shapes: returns [frames].
// Errors: INVALID_ARGUMENT naming `source` for a rig without hips, knees, feet, shoulders, elbows
// or
//         hands of its own, or one whose limbs have no length.
absl::StatusOr<std::vector<CharacterPose>> TransferToRig(const motion::Clip& clip,
                                                         const CharacterRig& rig,
                                                         absl::string_view source);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_RIG_TRANSFER_H_
