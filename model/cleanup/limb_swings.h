#ifndef DUET_MODEL_CLEANUP_LIMB_SWINGS_H_
#define DUET_MODEL_CLEANUP_LIMB_SWINGS_H_

#include "model/body/limbs.h"
#include "model/cleanup/hinge.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"

namespace duet::cleanup {

struct LimbSwingOptions {
  bool enabled = true;
  // The fastest turns, degrees per second: of the bones, seen from the trunk, and of the direction
  // in which an elbow points.
  double fastest_upper_arm = 350, fastest_forearm = 500;
  double fastest_thigh = 500, fastest_shin = 700;
  double fastest_elbow = 400;
  double fastest_foot = 4.5;  // metres per second, seen from the hips
  // Of elbows and knees.
  HingeLimits hinge{400, 600, 155};
};

// Slows down limbs that snap from one frame to the next. Limits how fast an elbow turns about the
// line from shoulder to hand, how fast each bone turns, and how fast the plane turns in which a
// limb bends. A faster turn is spread over more frames before and after it. Turns are measured
// relative to the trunk, which moves its limbs. Moves hands only where a bone is too fast, and feet
// only where the feet are. Preserves bone lengths, and leaves slower limbs unchanged.
void CalmLimbs(const body::Body& body, const LimbSwingOptions& options, const Timing& timing,
               motion::Poses* poses);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_LIMB_SWINGS_H_
