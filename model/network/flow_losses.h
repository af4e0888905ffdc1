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

// How far several answers to one clip are from being draws out of the distribution that the real
// motion is one of. Mean over the valid frames of
//
//   mean_a |x_a - x| - 1/2 mean_{a != b} |x_a - x_b|,   norms over all coordinates of a frame.
//
// Its expectation is smallest for answers that are distributed as the real motion is: too alike and
// too far apart both cost. Shapes: answers [A, N, T, V] with A of 2 or more, real [N, T, V].
// Source: energy score, Gneiting, Raftery 2007; as a loss of samplers, Shen, Meinshausen 2024.
torch::Tensor EnergyScores(const torch::Tensor& answers, const torch::Tensor& real,
                           const torch::Tensor& lengths);

// The same of what moves from frame to frame.
torch::Tensor VelocityEnergyScores(const torch::Tensor& answers, const torch::Tensor& real,
                                   const torch::Tensor& lengths);

// The same of `frames` successive velocities as one vector, divided by the root of `frames`: what
// belongs together over time. Blocks begin at every other frame; a clip too short for one scores 0.
torch::Tensor BlockEnergyScores(const torch::Tensor& answers, const torch::Tensor& real,
                                const torch::Tensor& lengths, int64_t frames);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_FLOW_LOSSES_H_
