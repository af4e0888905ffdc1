#ifndef DUET_MODEL_TRAINING_FLOW_STATISTICS_H_
#define DUET_MODEL_TRAINING_FLOW_STATISTICS_H_

#include <torch/torch.h>

#include <vector>

#include "model/checkpoint/manifest.h"
#include "model/dataset/dataset.h"

namespace duet::training {

// The tensors of the sampling generator that are measured on the training followers, each of them
// counted as captured and mirrored.
struct FlowStatistics {
  torch::Tensor base_poses;  // [C, 3 J] mean pose of each class, metres
  torch::Tensor
      noise_roots;  // [2, 3 J, 3 J] symmetric roots of the mean square of the offsets, in
                    // offset_scale metres: from the class's mean pose, from the first pose
};

// Requires a FlowArchitecture. `smoothing`: see FlowTraining::target_smoothing.
FlowStatistics MeasureFollowers(const checkpoint::Manifest& manifest,
                                const dataset::Dataset& dataset, const std::vector<int>& train,
                                double smoothing);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_FLOW_STATISTICS_H_
