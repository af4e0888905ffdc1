#ifndef DUET_MODEL_NETWORK_FLOW_LOSSES_H_
#define DUET_MODEL_NETWORK_FLOW_LOSSES_H_

#include <torch/torch.h>

#include <vector>

#include "model/motion/skeleton.h"

// The sampling generator's losses, each one number a window: [N]. Motions are [N, T, 3 J], lengths
// [N] int64; padded frames count for nothing.
namespace duet::network {

// Mean over the valid frames and coordinates of (x^ - x)^2.
torch::Tensor SquaredErrors(const torch::Tensor& predicted, const torch::Tensor& real,
                            const torch::Tensor& lengths);

// The same of what moves from frame to frame.
torch::Tensor SquaredDifferenceErrors(const torch::Tensor& predicted, const torch::Tensor& real,
                                      const torch::Tensor& lengths);

// Mean over the valid frames and bones of (l^ - l)^2. Units: those of the motions, squared.
torch::Tensor SquaredBoneErrors(const torch::Tensor& predicted, const torch::Tensor& real,
                                const torch::Tensor& lengths,
                                const std::vector<motion::Bone>& bones);

// Mean over the valid frames and feet of the squared distance that a foot moves from the frame
// before where the real one stands: moves less than `still`. Units: as `still`, squared.
torch::Tensor SquaredSlides(const torch::Tensor& predicted, const torch::Tensor& real,
                            const torch::Tensor& lengths, const motion::JointPair& feet,
                            double still);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_FLOW_LOSSES_H_
