#ifndef DUET_MODEL_TRAINING_FLOW_AUGMENT_H_
#define DUET_MODEL_TRAINING_FLOW_AUGMENT_H_

#include <functional>
#include <vector>

#include "model/base/random.h"
#include "model/engine/network.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/training/flow_batches.h"
#include "model/training/options.h"

// Changes to the examples of the sampling generator: histories and leaders as the generator meets
// them in long clips and live sessions.

namespace duet::training {

// Adds an error to the known first frames of a follower: tilts, bends, turns and displaces
// them, like a follower that has continued from its own answers for a while. The target starts with
// the same error and reaches the captured motion `options.frames` frames after the last known one.
// Requires a start pose. Shapes: target [frames, joints], as the input's leader. Source: like
// training on roll-outs (Ross et al. 2011), with invented errors.
void AddDrift(const motion::Skeleton& skeleton, const FlowTraining::Drift& options,
              base::Random* random, engine::NetworkInput* input, motion::Poses* target);

// Makes a window of a live session (engine::LiveSynthesis) of an example: at a random frame "now",
// up to `live.remade_seconds` after the last known frame, the leader is known for up to
// `live.delay_seconds` more and then comes to rest; the labels stay as they are now; and the window
// ends `live.future_seconds` after now. The target does not change.
//
// Units: frame_rate_hz of the example.
void HideFuture(const motion::Skeleton& skeleton, double frame_rate_hz,
                const FlowTraining::Live& live, base::Random* random, FlowExample* example);

// Answers of the network in training: one follower for each input, with its seed.
using Answer = std::function<std::vector<motion::Poses>(absl::Span<const engine::NetworkInput>)>;

// Lets examples continue from the network's own motion, as in long clips and live sessions, instead
// of a captured one. Of the examples with several known frames, each with probability `own.share`:
// the last of these frames, up to own.most_frames, are replaced by the network's answer, and
// the target becomes the captured motion plus what the answer differed by, which fades out over
// own.return_frames. The limbs of the target keep their captured lengths.
void ContinueOwnMotion(const motion::Skeleton& skeleton, const FlowTraining::Own& own,
                       const Answer& answer, base::Random* random,
                       std::vector<FlowExample>* examples);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_FLOW_AUGMENT_H_
