#ifndef DUET_MODEL_NETWORK_FLOW_INPUT_H_
#define DUET_MODEL_NETWORK_FLOW_INPUT_H_

#include <torch/torch.h>

#include "absl/types/span.h"
#include "model/checkpoint/manifest.h"
#include "model/engine/network.h"

namespace duet::network {

// The conditions of the sampling generator for a batch of windows, in the standard coordinates.
//
// Frames of a follower may be known: its start pose, or several settled frames. The base is the
// last known frame. Without known frames it is the mean pose of the classes, weighted by their mean
// label weights over the window (with frame_labels: of all classes alike), and moved to the start
// root if that is given. The network predicts
// offsets from the base, in units of FlowArchitecture::offset_scale.
struct FlowInput {
  torch::Tensor leader;    // [N, T, 3 J] metres, zero-padded
  torch::Tensor labels;    // [N, T, C] zero-padded
  torch::Tensor lengths;   // [N] int64, valid frames of each window, 1 to T
  torch::Tensor start;     // [N, StartFeatureCount]: the root or the last known pose, what is told
  torch::Tensor base;      // [N, 3 J] metres
  torch::Tensor known;     // [N, T, 3 J] the known frames' offsets from the base; 0 elsewhere
  torch::Tensor is_known;  // [N, T, 1] 1 where a frame is known
  torch::Tensor known_count;  // [N] int64
  torch::Tensor is_hidden;    // [N, T, 1] 1 where the leader is a guess

  FlowInput To(const torch::Device& device) const;
};

// Shapes: base_poses [C, 3 J] metres, the mean pose of each class. Requires a FlowArchitecture.
FlowInput MakeFlowInput(const checkpoint::Manifest& manifest, const torch::Tensor& base_poses,
                        absl::Span<const engine::NetworkInput> inputs);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_FLOW_INPUT_H_
