#ifndef DUET_MODEL_MOTION_POSTURE_H_
#define DUET_MODEL_MOTION_POSTURE_H_

#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

// Measures how people stand: their upward direction and the height of their feet. Both reveal a
// tilted camera.
//
// Units: world metres, y up.

namespace duet::motion {

// The direction of length 1 from the middle of the feet to the neck, in every frame; to the root if
// the skeleton has no joint "neck". Omits frames in which the two coincide. Empty for a skeleton
// without feet.
std::vector<Vec3> StandingDirections(const Skeleton& skeleton, const Poses& poses);

// The lower foot of every frame; empty for a skeleton without feet.
std::vector<Vec3> LowerFeet(const Skeleton& skeleton, const Poses& poses);

// A mean that is robust to outliers: points farther from it than twice the median distance have
// proportionally smaller weights (Huber). The origin if there are no points.
Vec3 RobustMean(const std::vector<Vec3>& points);

// The lean of a direction from +y towards +x and towards +z. Unit: degrees.
struct Lean {
  double x = 0;
  double z = 0;
};
Lean LeanOf(Vec3 up);
// The lean of the mean of directions.
Lean MeanLean(const std::vector<Vec3>& directions);

// The quantile `share` (0 to 1) of the points' heights. Requires at least one point.
float HeightQuantile(const std::vector<Vec3>& points, double share);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_POSTURE_H_
