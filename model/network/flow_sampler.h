#ifndef DUET_MODEL_NETWORK_FLOW_SAMPLER_H_
#define DUET_MODEL_NETWORK_FLOW_SAMPLER_H_

#include <torch/torch.h>

#include <vector>

#include "absl/types/span.h"
#include "model/engine/network.h"
#include "model/network/flow_generator.h"

namespace duet::network {

// Classifier-free guidance by label weights. With u the answer for no class and x_k that for class
// k:
//
//   x^ = u + sum_k w_k (x_k - u) = (1 - sum_k w_k) u + sum_k w_k x_k
//
// w_k is the window's weight of the class, multiplied by `guidance` if it is above 0. It may differ
// from frame to frame. Terms whose factor is 0 in every frame are omitted.
// Source: Ho, Salimans 2022 (classifier-free guidance); several labels as Liu et al. 2022.
struct GuidanceTerms {
  torch::Tensor windows;  // [R] int64, the window of each term
  torch::Tensor labels;   // [R, C] zeros, or one class
  torch::Tensor factors;  // [R, T, 1]
};
// Shapes: labels [N, T, C], lengths [N].
GuidanceTerms MakeGuidanceTerms(const torch::Tensor& labels, const torch::Tensor& lengths,
                                double guidance);

// Samples several answers to each window without guidance, for training: in units of offset_scale,
// with the network's own output in the known frames. Shapes: labels [N, C], source [A, N, T, 3 J];
// returns [A, N, T, 3 J].
torch::Tensor PlainAnswers(const FlowGenerator& generator,
                           const checkpoint::FlowArchitecture& architecture, const FlowInput& input,
                           const torch::Tensor& labels, const torch::Tensor& source);

// Integrates from noise to motion in a few Euler steps; every step moves the known frames towards
// their known values. Shapes: source [N, T, 3 J] in units of offset_scale. Returns followers
// [N, T, 3 J] in metres. Their known frames are exact; the frames after them are shifted to
// continue from the last known frame, by an amount that fades out.
torch::Tensor SampleFlow(const FlowGenerator& generator,
                         const checkpoint::FlowArchitecture& architecture, const FlowInput& input,
                         const torch::Tensor& source);

// Answers windows of any lengths with the seed and variety of each, on the generator's device.
// Returns [N, T, 3 J] in the processor's memory, metres.
torch::Tensor AnswerWindows(const FlowGenerator& generator, const checkpoint::Manifest& manifest,
                            absl::Span<const engine::NetworkInput> inputs);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_FLOW_SAMPLER_H_
