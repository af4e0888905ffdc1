#ifndef DUET_MODEL_FORMATS_BVH_BVH_EXPORT_H_
#define DUET_MODEL_FORMATS_BVH_BVH_EXPORT_H_

#include "absl/status/statusor.h"
#include "model/formats/bvh/bvh_document.h"
#include "model/formats/bvh/bvh_motion.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::formats::bvh {

// Converts one person to joint angles in units of `metres_per_unit` (0.01: centimetres, which
// animation tools assume), y up, in the clip's world, with the rest pose of MakeRig. The root has
// six channels, every other joint three. Rotations apply as Rz Rx Ry. Angles are continuous from
// frame to frame. If bone lengths are constant, positions are exact; otherwise a joint is off by
// the sum of the differences between the bones from the root to the joint and their medians.
//
// Errors: INVALID_ARGUMENT if the clip's joints are not the skeleton's, it has no frame, its frame
//         rate is out of range or a position is not finite.
absl::StatusOr<BvhDocument> ToBvh(const motion::Clip& clip, const motion::Skeleton& skeleton,
                                  double metres_per_unit = 0.01, const BvhKeys& keys = {});

}  // namespace duet::formats::bvh

#endif  // DUET_MODEL_FORMATS_BVH_BVH_EXPORT_H_
