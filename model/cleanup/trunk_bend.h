#ifndef DUET_MODEL_CLEANUP_TRUNK_BEND_H_
#define DUET_MODEL_CLEANUP_TRUNK_BEND_H_

#include "absl/types/span.h"
#include "model/body/limbs.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::cleanup {

// Rotates everything except the legs about the middle of the hips. Feet stay and knees follow.
// Requires a skeleton with hips, and an axis of length 1.
void BendAtHips(const motion::Skeleton& skeleton, const body::Body& body, motion::Vec3 axis,
                float radians, absl::Span<motion::Vec3> pose);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_TRUNK_BEND_H_
