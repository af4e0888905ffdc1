#ifndef DUET_MODEL_CLEANUP_SPACING_H_
#define DUET_MODEL_CLEANUP_SPACING_H_

#include <vector>

#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/vec3.h"

namespace duet::cleanup {

struct SpacingOptions {
  bool enabled = true;
  // Horizontal distance of the roots.
  double nearest_metres = 0.15;
  double farthest_metres = 2.5;
  // Being out of it lasts when it outlives a Gaussian of this deviation.
  double sigma_seconds = 0.5;
  double fastest_metres_per_second = 0.5;  // of the correction
};

// Moves every frame by its shift, none of those that are settled, and where something is settled no
// faster than told: the body goes there, it does not jump. Shapes: shifts [frames].
void ShiftBody(const std::vector<motion::Vec3>& shifts, double fastest_metres_per_second,
               const Timing& timing, motion::Poses* poses);

// Moves a follower that is too far from its leader, or too near, for longer than a moment.
void KeepSpacing(int root, const motion::Poses& leader, const SpacingOptions& options,
                 const Timing& timing, motion::Poses* follower);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_SPACING_H_
