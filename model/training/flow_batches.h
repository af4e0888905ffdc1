#ifndef DUET_MODEL_TRAINING_FLOW_BATCHES_H_
#define DUET_MODEL_TRAINING_FLOW_BATCHES_H_

#include <torch/torch.h>

#include <functional>
#include <vector>

#include "model/network/flow_input.h"
#include "model/training/sampler.h"

namespace duet::training {

// The clips of one training step of the sampling generator.
struct FlowBatch {
  network::FlowInput input;
  torch::Tensor labels;  // [N, C] the class, or zeros if it is withheld
  torch::Tensor target;  // [N, T, 3 J] offsets from input.base, in offset_scale metres
};

// A captured example in the standard coordinates, its follower smoothed.
struct FlowExample {
  engine::NetworkInput input;
  motion::Poses target;
};
FlowExample MakeFlowExample(const checkpoint::Manifest& manifest, const dataset::Dataset& dataset,
                            const Example& example, double smoothing);

// The passes of an epoch over `sequences` training sequences, and the steps that it takes: as set,
// or as many more as the run needs for its least number of steps. Require a FlowTraining.
int64_t PassesPerEpoch(const TrainingOptions& options, size_t sequences);
int64_t StepsPerEpoch(const TrainingOptions& options, size_t sequences);

// Answers of the network in training: one follower for each input, with its seed.
using Answer = std::function<std::vector<motion::Poses>(absl::Span<const engine::NetworkInput>)>;

// The batches of one epoch: every training sequence once in every pass, augmented, with no start,
// the root, the first pose or several known frames. Depends only on options, data, epoch and, if
// `answer` is not null, on the network: clips may then continue its own motion (own_history.h).
// Shapes: base_poses [C, 3 J]. Requires a FlowTraining.
std::vector<FlowBatch> SampleFlowEpoch(const checkpoint::Manifest& manifest,
                                       const dataset::Dataset& dataset,
                                       const torch::Tensor& base_poses,
                                       const std::vector<int>& train,
                                       const TrainingOptions& options, int64_t epoch,
                                       const Answer& answer);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_FLOW_BATCHES_H_
