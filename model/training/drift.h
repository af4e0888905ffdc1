#ifndef DUET_MODEL_TRAINING_DRIFT_H_
#define DUET_MODEL_TRAINING_DRIFT_H_

#include "model/base/random.h"
#include "model/engine/network.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/training/flow_training.h"

namespace duet::training {

// Adds an error to the known first frames of a follower: tilts, bends, turns, twists and displaces
// them, like a follower that has continued from its own answers for a while. The target starts with
// the same error and reaches the captured motion `options.frames` frames after the last known one.
// Requires a start pose. Shapes: target [frames, joints], as the input's leader. Source: like
// training on roll-outs (Ross et al. 2011), with invented errors.
void AddDrift(const motion::Skeleton& skeleton, const FlowTraining::Drift& options,
              base::Random* random, engine::NetworkInput* input, motion::Poses* target);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_DRIFT_H_
