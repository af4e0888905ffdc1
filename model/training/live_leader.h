#ifndef DUET_MODEL_TRAINING_LIVE_LEADER_H_
#define DUET_MODEL_TRAINING_LIVE_LEADER_H_

#include "model/base/random.h"
#include "model/motion/skeleton.h"
#include "model/training/flow_batches.h"
#include "model/training/flow_training.h"

namespace duet::training {

// Makes a window of a live session (engine::LiveSynthesis) of an example: at a random frame "now",
// up to `live.remade_seconds` after the last known frame, the leader is known for up to
// `live.delay_seconds` more and then comes to rest; the labels stay as they are now; and the window
// ends `live.future_seconds` after now. The target does not change.
//
// Units: frame_rate_hz of the example.
void HideFuture(const motion::Skeleton& skeleton, double frame_rate_hz,
                const FlowTraining::Live& live, base::Random* random, FlowExample* example);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_LIVE_LEADER_H_
