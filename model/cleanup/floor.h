#ifndef DUET_MODEL_CLEANUP_FLOOR_H_
#define DUET_MODEL_CLEANUP_FLOOR_H_

#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

struct FloorOptions {
  bool enabled = true;
  // Feet within the first distance above or below the floor are not corrected. After correction,
  // none are beyond the second.
  double free_metres = 0.015;
  double most_metres = 0.035;
  // A shorter time in the air is a jump and is not corrected.
  double jump_seconds = 0.2;
};

// Returns the height of the floor under a motion: a low percentile of the heights of its lower
// foot, so that jumps and tracking errors do not change it.
float FloorHeight(const motion::JointPair& feet, const motion::Poses& poses);

// Lifts or lowers a body that is below the floor, or above it for longer than a jump. Does nothing
// for a skeleton without feet.
void StandOnFloor(const motion::Skeleton& skeleton, float floor, const FloorOptions& options,
                  const Timing& timing, motion::Poses* poses);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_FLOOR_H_
