#ifndef DUET_MODEL_FORMATS_USD_USDA_EXPORT_H_
#define DUET_MODEL_FORMATS_USD_USDA_EXPORT_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/motion/clip.h"
#include "model/motion/provenance.h"
#include "model/motion/skeleton.h"

namespace duet::formats::usd {

// One person or a leader and a follower as text USD: skinned mannequins with a UsdSkel skeleton
// each, metres, y up, in the clips' world, everybody at rest in the T pose of MakeRig with the feet
// on the floor at the origin. A time code is a frame; its rate is the clip's. Every joint stands
// exactly where its clip has it. What `provenance` says is in the customData of the prim above
// both; it may be null.
//
//   /pair                        default prim; of one person /person_alone
//     leader, follower           SkelRoot; of one person: person
//       skeleton                 joints, bind and rest transforms
//         animation              SkelAnimation
//       mannequin, visor         meshes, every vertex with one joint
//     materials                  UsdPreviewSurface
//
// Errors: INVALID_ARGUMENT when there are not one or two people, their joints are not the
//         skeleton's, they differ in frames or rate, or a position is not finite.
absl::StatusOr<std::string> FormatUsda(const std::vector<motion::Clip>& people,
                                       const motion::Skeleton& skeleton,
                                       const motion::Provenance* provenance);

}  // namespace duet::formats::usd

#endif  // DUET_MODEL_FORMATS_USD_USDA_EXPORT_H_
