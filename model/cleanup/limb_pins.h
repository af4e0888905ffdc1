#ifndef DUET_MODEL_CLEANUP_LIMB_PINS_H_
#define DUET_MODEL_CLEANUP_LIMB_PINS_H_

#include <functional>

#include "model/body/limbs.h"
#include "model/cleanup/offset_track.h"
#include "model/cleanup/timing.h"
#include "model/motion/pin.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

// Limits the joints of all limbs to their ranges.
using KeepRanges = std::function<void(motion::Poses*)>;

// A limb of a skeleton, with the limits of the corrections that move it to pins.
struct PinnedLimb {
  const motion::Skeleton& skeleton;
  const body::Limb& limb;
  bool is_leg = false;
  OffsetLimits limits;
};

// Whether a joint moves with a limb: its middle, its end, or a joint beyond that.
bool MovesWith(const body::Limb& limb, int joint);

// Moves the joints of a limb to their pins by rotating its bones, and eases the corrections in and
// out. A pinned end turns about the upper joint and bends the limb: on the straight way it could
// pass through that joint. A pin that is nearer to the upper joint than a folded limb, or farther
// than a stretched one, is approached as far as the limb folds or stretches.
//
// The correction makes no joint of the limb faster than `limits.fastest_metres_per_second`, within
// a tenth: the corrections of pins that would do so are reduced. Requires pins that are sorted by
// joint and then by frame. Joints of other limbs do not change.
//
// Cost: linear in the frames and pins; up to 28 times that if corrections are reduced.
void MoveToPins(const PinnedLimb& limb, const motion::Pins& pins, const KeepRanges& keep_ranges,
                const Timing& timing, motion::Poses* poses);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_LIMB_PINS_H_
