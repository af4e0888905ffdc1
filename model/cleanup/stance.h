#ifndef DUET_MODEL_CLEANUP_STANCE_H_
#define DUET_MODEL_CLEANUP_STANCE_H_

#include "model/body/limbs.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

struct StanceOptions {
  bool enabled = true;
  // Feet that stay astride for longer than this come together. 0: never.
  double longest_seconds = 0;
  // How long they take.
  double ease_seconds = 0.5;
};

// Brings feet under the hips that stay astride (body::IsAstride) for longer than people leave them
// so. Networks that go on from their own frames can leave one foot behind for many seconds. Moves
// the tracks of both feet along the floor by rotating the bones of the legs; footsteps make steps
// of it. Does nothing for a skeleton without hips or without two legs of two bones.
void NarrowStance(const motion::Skeleton& skeleton, const body::Body& body,
                  const StanceOptions& options, const Timing& timing, motion::Poses* poses);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_STANCE_H_
