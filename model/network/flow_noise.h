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

// Drawn for each window from its sampling's seed alone, the same with every compiler.
NoiseNumbers DrawNoise(absl::Span<const engine::NetworkInput> inputs);

// What sampling starts from: offsets smooth in time that covary over the joints as the training
// followers' do. Where frames are known, their deviation grows with the distance from the last of
// them; else a part of each is the same in all frames.
// Shapes: roots [2, 3 J, 3 J] (no start told, start told), known_count [N] int64; returns
// [N, T, 3 J]. A window's frames do not depend on how many follow.
torch::Tensor SourceNoise(const checkpoint::FlowArchitecture::Noise& options,
                          const torch::Tensor& roots, const torch::Tensor& known_count,
                          const NoiseNumbers& numbers);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_FLOW_NOISE_H_
