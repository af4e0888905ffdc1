#ifndef DUET_MODEL_NETWORK_LOSSES_H_
#define DUET_MODEL_NETWORK_LOSSES_H_

#include <torch/torch.h>

#include <vector>

#include "model/motion/skeleton.h"

// Motions are [N, T, 3 J], lengths [N] int64. Padded frames are ignored.
namespace duet::network {

// The paper's losses, in the standard coordinates. Each is a scalar.

// Mean over the valid frames of sum over the coordinates of |x^ - x|.
// Source: paper section 3.4 (L1); this reduction makes its weight independent of batch and length.
torch::Tensor L1Loss(const torch::Tensor& predicted, const torch::Tensor& real,
                     const torch::Tensor& lengths);

// Mean over the valid frames of the Euclidean norm over all coordinates: the paper's AFD (Eq. 6).
torch::Tensor NormLoss(const torch::Tensor& predicted, const torch::Tensor& real,
                       const torch::Tensor& lengths);

// Mean over the valid frames of sum over the bones of |l^ - l| / l.
// Source: paper section 3.4 (L_b).
torch::Tensor BoneLoss(const torch::Tensor& predicted, const torch::Tensor& real,
                       const torch::Tensor& lengths, const std::vector<motion::Bone>& bones);

enum class ContinuityForm {
  kHinge,      // sum_t [ |x^_t - x^_{t-1}| - |x^_t - x^_{t-2}| + 0.1 m ]_+ (YXN17; the paper)
  kPathLength  // sum_t |x^_t - x^_{t-1}|: what the released code executes
};

// Mean over the valid frames; |.| sums over the joints the distance that each moves.
// Source: paper section 3.4 (L_c).
torch::Tensor ContinuityLoss(const torch::Tensor& predicted, const torch::Tensor& lengths,
                             ContinuityForm form);

// The discriminator's loss: real motion in its class, synthesised motion in the last output.
// Source: paper Eq. 4 in the semi-supervised form of Salimans et al. 2016. Shapes: logits
// [N, C + 1]; classes [N] int64.
torch::Tensor DiscriminatorLoss(const torch::Tensor& real_logits,
                                const torch::Tensor& synthesised_logits,
                                const torch::Tensor& classes);

// The generator's: its output in the wanted class. Shapes as above.
torch::Tensor AdversarialLoss(const torch::Tensor& synthesised_logits,
                              const torch::Tensor& classes);

// The sampling generator's losses, one value per window: [N].

// Mean over the valid frames and coordinates of (x^ - x)^2.
torch::Tensor SquaredErrors(const torch::Tensor& predicted, const torch::Tensor& real,
                            const torch::Tensor& lengths);

// The same for differences of successive frames.
torch::Tensor SquaredDifferenceErrors(const torch::Tensor& predicted, const torch::Tensor& real,
                                      const torch::Tensor& lengths);

// Mean over the valid frames and bones of (l^ - l)^2. Units: those of the motions, squared.
torch::Tensor SquaredBoneErrors(const torch::Tensor& predicted, const torch::Tensor& real,
                                const torch::Tensor& lengths,
                                const std::vector<motion::Bone>& bones);

// Energy score: compares the distribution of several answers to one clip with the real motion, one
// draw of the wanted distribution. Mean over the valid frames of
//
//   mean_a |x_a - x| - 1/2 mean_{a != b} |x_a - x_b|,   norms over all coordinates of a frame.
//
// Its expectation is smallest if the answers have the distribution of the real motion: too little
// and too much variety both raise it. Shapes: answers [A, N, T, V] with A of 2 or more, real [N, T,
// V]. Source: Gneiting, Raftery 2007; as a loss for samplers, Shen, Meinshausen 2024.
torch::Tensor EnergyScores(const torch::Tensor& answers, const torch::Tensor& real,
                           const torch::Tensor& lengths);

// The same for differences of successive frames.
torch::Tensor VelocityEnergyScores(const torch::Tensor& answers, const torch::Tensor& real,
                                   const torch::Tensor& lengths);

// The same for blocks of `frames` successive velocities, each as one vector divided by the square
// root of `frames`: it also scores dependence over time. A block begins at every other frame. A
// clip shorter than a block scores 0.
torch::Tensor BlockEnergyScores(const torch::Tensor& answers, const torch::Tensor& real,
                                const torch::Tensor& lengths, int64_t frames);

// The velocities of both feet, each divided by the root of its squared speed plus `still` squared:
// near 0 for a foot that stands, near a unit vector for one that moves. A score of them counts
// whether a foot stands, where a score of positions hardly notices a slide. Shapes: motion [..., T,
// 3 J]; returns [..., T - 1, 6]. `still` in the motion's units per frame.
torch::Tensor FootMotions(const torch::Tensor& motion, const motion::JointPair& feet, double still);

// The vectors from each hand of the leader to each hand of the follower, each divided by the root
// of its squared length plus `near` squared: they change most where hands nearly meet. Shapes:
// follower [..., N, T, 3 J], leader [N, T, 3 J]; returns [..., N, T, 12]. All in the same unit.
torch::Tensor HandPlaces(const torch::Tensor& follower, const torch::Tensor& leader,
                         const motion::JointPair& hands, double near);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_LOSSES_H_
