#ifndef DUET_MODEL_CLEANUP_FOOTSTEPS_H_
#define DUET_MODEL_CLEANUP_FOOTSTEPS_H_

#include <vector>

#include "model/body/limbs.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::cleanup {

struct FootstepOptions {
  bool enabled = true;
  // A foot steps while it is faster or higher above the floor than the second value, and lands when
  // both are below the first.
  double slow_metres_per_second = 0.3, fast_metres_per_second = 0.6;
  double low_metres = 0.08, high_metres = 0.12;
  // A standing foot that is this far from where the network has it takes a step of this length.
  double farthest_metres = 0.1;
  double step_seconds = 0.3;
  // While the other foot steps, a foot stands up to this distance.
  double stretched_metres = 0.35;
  double shortest_stand_seconds = 0.15;
};

// Where a foot is in every frame, and whether it stands there.
struct FootPath {
  std::vector<motion::Vec3> places;  // [frames]
  std::vector<bool> stands;          // [frames]
};

// Plans the steps of both feet: a foot stands at one place until it steps, and steps one at a time,
// except in a jump. A foot that stands too far from its track takes a step of its own, so that a
// body that moves steps instead of sliding. The settled frames decide how the feet start.
// Shapes: tracks of as many frames, one for each foot.
std::vector<FootPath> PlanFootsteps(const std::vector<std::vector<motion::Vec3>>& tracks,
                                    float floor, const FootstepOptions& options,
                                    const Timing& timing);

// Moves the feet along their planned paths by rotating thighs and shins. The body follows its feet,
// and sinks where its legs would not reach. Does nothing for a skeleton without legs of two bones.
void WalkInSteps(const motion::Skeleton& skeleton, const body::Body& body, float floor,
                 const FootstepOptions& options, const Timing& timing, motion::Poses* poses);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_FOOTSTEPS_H_
