#ifndef DUET_MODEL_DATASET_POSTURE_H_
#define DUET_MODEL_DATASET_POSTURE_H_

#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

// How people stand: which way is up for them, and where their feet are. Both tell a tilted camera.
//
// Units: world metres, y up.

namespace duet::dataset {

// From the middle of the feet to the neck, of length 1, in every frame; to the root where the
// skeleton has no joint "neck". Frames without such a direction (both in one place) are left out.
// None for a skeleton without feet.
std::vector<motion::Vec3> StandingDirections(const motion::Skeleton& skeleton,
                                             const motion::Poses& poses);

// The lower foot of every frame; none for a skeleton without feet.
std::vector<motion::Vec3> LowerFeet(const motion::Skeleton& skeleton, const motion::Poses& poses);

// A mean that far points hardly move: those farther from it than twice the median distance count
// in proportion less (Huber's weights). The origin for none.
motion::Vec3 RobustMean(const std::vector<motion::Vec3>& points);

// How far a direction leans from +y towards +x and towards +z. Unit: degrees.
struct Lean {
  double x = 0;
  double z = 0;
};
Lean LeanOf(motion::Vec3 up);
// Of the mean of directions.
Lean MeanLean(const std::vector<motion::Vec3>& directions);

// The slopes of the plane y = a x + b z + c through points, by least squares with Huber's weights.
// As a lean of the plane's normal, in degrees. {0, 0} where the points do not tell a plane.
Lean FloorLean(const std::vector<motion::Vec3>& points);

// The height that a share (0 to 1) of the points is below. Requires a point.
float HeightQuantile(const std::vector<motion::Vec3>& points, double share);

}  // namespace duet::dataset

#endif  // DUET_MODEL_DATASET_POSTURE_H_
