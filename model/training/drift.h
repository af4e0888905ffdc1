#ifndef DUET_MODEL_TRAINING_DRIFT_H_
#define DUET_MODEL_TRAINING_DRIFT_H_

#include "model/base/random.h"
#include "model/engine/network.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/training/options.h"

namespace duet::training {

// Moves what a follower is told of its first frames off what was captured: tilted, bent, turned and
// displaced, as a follower is that has gone on from its own answers for a while. The target leaves
// from there and is the captured motion again `options.frames` frames after the last told one.
// Requires a told pose. Shapes: target [frames, joints], as the input's leader.
// Source: like training on roll-outs (Ross et al. 2011), with the errors made up.
void AddDrift(const motion::Skeleton& skeleton, const TrainingOptions::Flow::Drift& options,
              base::Random* random, engine::NetworkInput* input, motion::Poses* target);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_DRIFT_H_
