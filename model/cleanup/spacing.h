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
  // Standard deviation of the Gaussian that removes short violations.
  double sigma_seconds = 0.5;
  // Maximum speed of the correction: the leader's mean speed along the floor plus the first value,
  // so that a follower keeps up with a leader who walks, but at most the second, so that it is not
  // dragged after one who jumps.
  double faster_metres_per_second = 0.5, fastest_metres_per_second = 2;
};

// Moves every frame except the settled ones by its shift. If there are settled frames, limits the
// speed of the correction, so that the body does not jump. Shapes: shifts [frames].
void ShiftBody(const std::vector<motion::Vec3>& shifts, double fastest_metres_per_second,
               const Timing& timing, motion::Poses* poses);

// Corrects a follower that is too far from its leader, or too near, except for short violations.
void KeepSpacing(int root, const motion::Poses& leader, const SpacingOptions& options,
                 const Timing& timing, motion::Poses* follower);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_SPACING_H_
