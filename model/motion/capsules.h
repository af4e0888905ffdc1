#ifndef DUET_MODEL_MOTION_CAPSULES_H_
#define DUET_MODEL_MOTION_CAPSULES_H_

#include <vector>

#include "model/motion/body_part.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

// A body as capsules: each bone is a segment with a radius.
namespace duet::motion {

// The closest points of two segments, and their distance.
struct ClosestPoints {
  Vec3 on_a, on_b;
  double distance = 0;
};
// For the segments a0-a1 and b0-b1; either may be a point.
ClosestPoints FindClosestPoints(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1);
double SegmentDistance(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1);

// The radius of the capsule around each bone, metres: 0.045 for a bone within a part with "arm" in
// its name, 0.065 with "leg", 0.09 for the bone that ends in a joint called "head", 0.11 for any
// other (trunk, shoulders, hips). Shapes: returns [bones].
// Source: half the breadth of adult limbs; for the trunk less than half its breadth, because its
// bones fan out from the middle. This is an approximation: compare figures with those of captured
// pairs, not with zero.
std::vector<double> CapsuleRadii(const Skeleton& skeleton, const std::vector<BodyPart>& parts);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_CAPSULES_H_
