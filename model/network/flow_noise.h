#ifndef DUET_MODEL_NETWORK_FLOW_NOISE_H_
#define DUET_MODEL_NETWORK_FLOW_NOISE_H_

#include <torch/torch.h>

#include "absl/types/span.h"
#include "model/checkpoint/flow_architecture.h"
#include "model/engine/network.h"

namespace duet::network {

// Standard normal numbers, [N, T, 3 J] each.
struct NoiseNumbers {
  torch::Tensor smooth;  // becomes smooth in time
  torch::Tensor white;   // stays as it is
};

// Draws each window's numbers only from its Sampling::seed, with the same result on every compiler.
NoiseNumbers DrawNoise(absl::Span<const engine::NetworkInput> inputs);

// The source of sampling: offsets that are smooth in time and have the joint covariance of the
// training followers. After known frames their deviation grows with the distance from the last one;
// without known frames, a part of the offset is constant over the window.
// Shapes: roots [2, 3 J, 3 J] (without a start, with a start), known_count [N] int64; returns
// [N, T, 3 J]. A frame does not depend on the number of frames after it.
torch::Tensor SourceNoise(const checkpoint::FlowArchitecture::Noise& options,
                          const torch::Tensor& roots, const torch::Tensor& known_count,
                          const NoiseNumbers& numbers);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_FLOW_NOISE_H_
