#ifndef DUET_MODEL_CLEANUP_LASTING_H_
#define DUET_MODEL_CLEANUP_LASTING_H_

#include <functional>
#include <vector>

#include "model/cleanup/timing.h"

namespace duet::cleanup {

// What people do for a while, but not for long.
struct Lasting {
  double longest_seconds = 0;
  // How long it takes to correct what lasts longer.
  double ease_seconds = 0;
  // How long it has lasted before the first frame.
  double before_seconds = 0;
};

// How far something is corrected in each frame, 0 to 1: from the time when it has lasted too long,
// until it ends. `lasts`: whether it does in a frame. Settled frames count, but are not corrected.
// Empty if nothing is corrected. Shapes: returns [frames].
std::vector<float> SharesOfLasting(const std::function<bool(int)>& lasts, const Lasting& lasting,
                                   const Timing& timing, int frames);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_LASTING_H_
