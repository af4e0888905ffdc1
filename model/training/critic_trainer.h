#ifndef DUET_MODEL_TRAINING_CRITIC_TRAINER_H_
#define DUET_MODEL_TRAINING_CRITIC_TRAINER_H_

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/dataset/dataset.h"
#include "model/training/flow_training.h"

namespace duet::training {

// A trained critic and its mean loss in the last tenth of the steps; 0.69: it cannot tell captured
// followers from sampled ones.
struct TrainedCritic {
  std::vector<checkpoint::Tensor> tensors;  // in the order of checkpoint::CriticTensors
  double loss = 0;
};

// Trains a critic (model/engine/critic.h) for a finished generator, on one device and in a few
// seconds. It learns to tell the captured followers of the sequences `train` from the generator's
// own answers to their leaders. Both pass the stages of a server, with and without a first pose.
// The result depends only on the arguments. Errors: INTERNAL if an answer is not finite.
// Requires a generator that samples, at least one sequence and at least one step.
absl::StatusOr<TrainedCritic> TrainCritic(const FlowTraining& flow, uint64_t seed,
                                          const checkpoint::Checkpoint& generator,
                                          const dataset::Dataset& dataset,
                                          const std::vector<int>& train);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_CRITIC_TRAINER_H_
