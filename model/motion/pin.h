#ifndef DUET_MODEL_MOTION_PIN_H_
#define DUET_MODEL_MOTION_PIN_H_

#include <vector>

#include "model/motion/vec3.h"

namespace duet::motion {

// A place where a joint is to be at one time.
struct Pin {
  int joint = 0;
  double frame = 0;  // can lie between two frames, and after the last one
  Vec3 position;
  float softness = 0;  // share of the distance that may remain, in [0, 1]
};
using Pins = std::vector<Pin>;

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_PIN_H_
