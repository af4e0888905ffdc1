#ifndef DUET_MODEL_NETWORK_LOSSES_H_
#define DUET_MODEL_NETWORK_LOSSES_H_

#include <torch/torch.h>

#include <vector>

#include "model/motion/skeleton.h"

// One equation, one function. Motions are [N, T, 3 J] in the standard coordinates, lengths [N]
// int64. Padded frames are ignored. Every loss is a scalar.
namespace duet::network {

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

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_LOSSES_H_
