#ifndef DUET_MODEL_CLEANUP_HINGE_H_
#define DUET_MODEL_CLEANUP_HINGE_H_

#include <vector>

#include "model/cleanup/timing.h"
#include "model/motion/vec3.h"

namespace duet::cleanup {

struct HingeLimits {
  double fastest_plane = 0;  // turn of the plane about the upper bone, degrees per second
  double fastest_bend = 0;   // bending or straightening, degrees per second
  double folded = 180;       // the largest bend, degrees
};

// Lets a knee or an elbow be a hinge over time: the plane in which a limb bends turns about the
// upper bone no faster than a limb can, and the limb bends no faster. A limb that is nearly
// straight, and so does not show its plane, keeps the one before. Changes the lower bone in the
// frames after the settled ones; none where the limits hold.
//
// Shapes: upper, lower [frames], the directions of the bones, of length 1.
void LimitHinge(const std::vector<motion::Vec3>& upper, const HingeLimits& limits,
                const Timing& timing, std::vector<motion::Vec3>* lower);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_HINGE_H_
