#ifndef DUET_MODEL_NETWORK_FLOW_INPUT_H_
#define DUET_MODEL_NETWORK_FLOW_INPUT_H_

#include <torch/torch.h>

#include "absl/types/span.h"
#include "model/checkpoint/manifest.h"
#include "model/engine/network.h"

namespace duet::network {

// What the sampling generator is told of a batch of windows, in the standard coordinates.
//
// A follower's frames may be known: the pose it starts with, or several frames that are settled
// already. Its base is the last of them; without any, the mean pose of its classes by their weights
// over the window, moved to the root where that is told. The network speaks of offsets from the
// base, in units of FlowArchitecture::offset_scale.
struct FlowInput {
  torch::Tensor leader;    // [N, T, 3 J] metres, zero-padded
  torch::Tensor labels;    // [N, T, C] zero-padded
  torch::Tensor lengths;   // [N] int64, valid frames of each window, 1 to T
  torch::Tensor start;     // [N, StartFeatureCount]: the root or the last known pose, what is told
  torch::Tensor base;      // [N, 3 J] metres
  torch::Tensor known;     // [N, T, 3 J] the known frames' offsets from the base; 0 elsewhere
  torch::Tensor is_known;  // [N, T, 1] 1 where a frame is known
  torch::Tensor known_count;  // [N] int64
};

// Shapes: base_poses [C, 3 J] metres, the mean pose of each class. Requires manifest.flow.
FlowInput MakeFlowInput(const checkpoint::Manifest& manifest, const torch::Tensor& base_poses,
                        absl::Span<const engine::NetworkInput> inputs);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_FLOW_INPUT_H_
