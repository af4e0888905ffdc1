#ifndef DUET_MODEL_NETWORK_FLOW_NOISE_H_
#define DUET_MODEL_NETWORK_FLOW_NOISE_H_

#include <torch/torch.h>

#include "absl/types/span.h"
#include "model/checkpoint/architecture.h"
#include "model/engine/network.h"

namespace duet::network {

// Standard normal numbers, [N, T, 3 J] each.
struct NoiseNumbers {
  torch::Tensor smooth;  // becomes smooth in time, or is so in windows of an endless motion
  torch::Tensor white;   // stays as it is
  // Which windows belong to an endless motion (Sampling::first_frame), and the numbers that are the
  // same in all of its frames: [N, 1, 1] of bool and [N, 1, 3 J]. Undefined if there are none.
  torch::Tensor endless = {};
  torch::Tensor constant = {};

  NoiseNumbers To(const torch::Device& device) const;
};

// Draws each window's numbers only from its Sampling::seed and first_frame, with the same result on
// every compiler. `frame_length`: of the architecture's noise.
NoiseNumbers DrawNoise(absl::Span<const engine::NetworkInput> inputs, double frame_length);

// The same for training: drawn from LibTorch's generator, shaped like `motion` [N, T, 3 J].
// `endless` [N, 1, 1] of bool, or undefined if there are none.
NoiseNumbers RandomNumbers(const torch::Tensor& motion, const torch::Tensor& endless,
                           double frame_length);

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
