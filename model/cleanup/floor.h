#ifndef DUET_MODEL_CLEANUP_FLOOR_H_
#define DUET_MODEL_CLEANUP_FLOOR_H_

#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

struct FloorOptions {
  bool enabled = true;
  // Feet up to the first distance above or below the floor are left alone; none stay beyond the
  // second. Metres.
  double free_metres = 0.015;
  double most_metres = 0.035;
  // What is in the air for less is a jump, and stays.
  double jump_seconds = 0.2;
};

// Where the floor is that a motion stands on: a low percentile of its lower foot's heights, so that
// neither a jump nor a foot that a tracker loses moves it.
float FloorHeight(const motion::JointPair& feet, const motion::Poses& poses);

// Lifts or lowers a body that is below the floor, or above it for longer than a jump. A skeleton
// without feet stays as it is.
void StandOnFloor(const motion::Skeleton& skeleton, float floor, const FloorOptions& options,
                  const Timing& timing, motion::Poses* poses);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_FLOOR_H_
