#ifndef DUET_MODEL_CLEANUP_OFFSET_TRACK_H_
#define DUET_MODEL_CLEANUP_OFFSET_TRACK_H_

#include <vector>

#include "model/cleanup/timing.h"
#include "model/motion/vec3.h"

namespace duet::cleanup {

// A correction that is to apply in full at one time.
struct Offset {
  double frame = 0;  // can lie between two frames, and after the last one
  motion::Vec3 way;
};

struct OffsetLimits {
  double ease_seconds = 0;               // shortest time in which an offset comes and goes
  double gentle_metres_per_second = 0;   // longer offsets take longer than that
  double fastest_metres_per_second = 0;  // if there is less time, they are shortened
};

// Returns corrections of all frames whose spline (SampleCubic) passes through the offsets. They are
// zero in the settled frames and far from every offset. Between two offsets that are near, the
// correction changes from one to the other. Shortens those that would be too fast; the first of two
// near offsets counts. Requires offsets in ascending order of frames, after the settled ones.
// Shapes: returns [frames].
std::vector<motion::Vec3> OffsetTrack(std::vector<Offset> offsets, const OffsetLimits& limits,
                                      const Timing& timing, int frames);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_OFFSET_TRACK_H_
