#ifndef DUET_MODEL_CLEANUP_STRIKES_H_
#define DUET_MODEL_CLEANUP_STRIKES_H_

#include "model/body/limbs.h"
#include "model/body/surface.h"
#include "model/cleanup/hand_contact.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

struct StrikeOptions {
  bool enabled = true;
  // How far the body comes at most, metres.
  double farthest_metres = 0.6;
  // The time in which it comes and goes, and its speed if that is too short for the way.
  double ease_seconds = 0.4, gentle_metres_per_second = 0.6;
  double fastest_metres_per_second = 1.0;
};

// Lets a fist or foot that the leader reaches out end near the follower's body where the labels ask
// for it: the follower comes by the time at which it is nearest, and goes back afterwards. Moves
// the whole body along the floor. `meetings` has as many frames as the follower.
void ApproachStrikes(const motion::Skeleton& skeleton, const body::Body& body,
                     const body::Surface& surface, const motion::Poses& leader,
                     const Meetings& meetings, const StrikeOptions& options, const Timing& timing,
                     motion::Poses* follower);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_STRIKES_H_
