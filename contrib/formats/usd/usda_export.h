#ifndef DUET_CONTRIB_FORMATS_USD_USDA_EXPORT_H_
#define DUET_CONTRIB_FORMATS_USD_USDA_EXPORT_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::contrib::formats::usd {

// Writes one person, or a leader and a follower, as text USD: skinned mannequins, each with a
// UsdSkel skeleton, in metres, y up, in the clips' world. The rest pose is the T pose of MakeRig
// with the feet on the floor at the origin. A time code is a frame, and its rate is the clip's.
// Every joint is exactly at its position in the clip.
//
//   /pair                        default prim; for one person: /person_alone
//     leader, follower           SkelRoot; for one person: person
//       skeleton                 joints, bind and rest transforms
//         animation              SkelAnimation
//       mannequin, visor         meshes, every vertex with one joint
//     materials                  UsdPreviewSurface
//
// Errors: INVALID_ARGUMENT if there are not one or two people, their joints are not the
//         skeleton's, they differ in frames or rate, or a position is not finite.
absl::StatusOr<std::string> FormatUsda(const std::vector<motion::Clip>& people,
                                       const motion::Skeleton& skeleton);

}  // namespace duet::contrib::formats::usd

#endif  // DUET_CONTRIB_FORMATS_USD_USDA_EXPORT_H_
