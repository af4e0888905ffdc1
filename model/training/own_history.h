#ifndef DUET_MODEL_TRAINING_OWN_HISTORY_H_
#define DUET_MODEL_TRAINING_OWN_HISTORY_H_

#include <functional>
#include <vector>

#include "model/base/random.h"
#include "model/motion/skeleton.h"
#include "model/training/flow_batches.h"
#include "model/training/flow_training.h"

namespace duet::training {

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

#endif  // DUET_MODEL_TRAINING_OWN_HISTORY_H_
