#ifndef DUET_MODEL_FORMATS_BVH_BVH_EXPORT_H_
#define DUET_MODEL_FORMATS_BVH_BVH_EXPORT_H_

#include "absl/status/statusor.h"
#include "model/formats/bvh/bvh_document.h"
#include "model/formats/bvh/bvh_motion.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::formats::bvh {

// One person as joint angles: units of `metres_per_unit` (0.01: centimetres, as animation tools
// take BVH to be), y up, in the clip's world, the rest pose of MakeRig. The root has six channels,
// every other joint three; rotations apply as Rz Rx Ry; angles are continuous from frame to frame.
// Positions are kept exactly where bone lengths are constant; elsewhere a joint is off by as much
// as the bones on its way from the root differ from their medians.
//
// Errors: INVALID_ARGUMENT when the clip's joints are not the skeleton's, it has no frame, its rate
//         is no rate or a position is not finite.
absl::StatusOr<BvhDocument> ToBvh(const motion::Clip& clip, const motion::Skeleton& skeleton,
                                  double metres_per_unit = 0.01, const BvhKeys& keys = {});

}  // namespace duet::formats::bvh

#endif  // DUET_MODEL_FORMATS_BVH_BVH_EXPORT_H_
