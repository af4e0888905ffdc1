#ifndef DUET_MODEL_CLEANUP_STAND_UP_H_
#define DUET_MODEL_CLEANUP_STAND_UP_H_

#include <vector>

#include "model/body/limbs.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"

namespace duet::cleanup {

// Returns how high the hips are above the lower foot in every frame, in lengths of the leg: 1 for
// straight legs. Smoothed over about a second, so that a short dip does not count. Requires legs.
// Shapes: returns [frames].
std::vector<float> LastingHipHeights(const body::Body& body, const motion::Poses& poses,
                                     double frame_rate_hz);

// Raises a body whose hips are lower than `least` for longer than a dip: a network that continues
// its own motion can sink into a crouch, and then stays in it. The feet keep their positions, so a
// body is raised at most as far as both legs reach. Does nothing for a skeleton without legs of two
// bones. `least`: as LastingHipHeights.
void StandUp(const body::Body& body, double least, const Timing& timing, motion::Poses* poses);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_STAND_UP_H_
