#ifndef DUET_MODEL_CLEANUP_FRAME_TURNS_H_
#define DUET_MODEL_CLEANUP_FRAME_TURNS_H_

#include "absl/types/span.h"
#include "model/body/limbs.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::cleanup {

struct FrameTurnOptions {
  // The fastest turn of a shoulder about the chest and of the hips about the trunk, degrees per
  // second.
  double fastest_shoulder = 400, fastest_hips = 360;
  // The fastest turn of a bone against the bone or the trunk that it hangs from, degrees per
  // second. A rig's shoulders move besides.
  double fastest_bone = 720, fastest_upper_arm = 550;
  // The largest turn of the plane in which a limb bends, in a frame and in a second.
  double most_plane_degrees = 35, fastest_plane = 600;
  // The same of a plane against the shoulders or hips, degrees per second.
  double fastest_plane_of_girdle = 700;
  // A foot that moves less than this stands: it stays where it is, whatever its leg does.
  double stands_metres_per_second = 0.1;
};

// Slows down shoulders, hips and limbs of one frame that the caller gets, as far as they turn too
// fast since the frame before. CalmLimbs limits the turns of a window at the model's frame rate,
// but windows are blended and frames interpolated afterwards: a spline that changes its direction
// within a planned frame is faster than the plan.
//
// Feet stay where they are while the hips are slowed down. What is slowed down follows in the next
// frames. Preserves bone lengths and standing feet. Depends only on both frames, so it suits live
// sessions. Shoulders that are not attached to the chest are left alone. Shapes: poses [joints].
void SlowFrame(const motion::Skeleton& skeleton, const body::Body& body,
               const FrameTurnOptions& options, double frame_rate_hz,
               absl::Span<const motion::Vec3> before, absl::Span<motion::Vec3> pose);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_FRAME_TURNS_H_
