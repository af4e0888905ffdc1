#include "model/network/losses.h"

#include "model/network/sequence.h"

namespace duet::network {
namespace {

namespace F = torch::nn::functional;

// Keeps the gradient of a length finite where two points coincide.
constexpr double kLengthFloor = 1e-12;

// [N, T] 1 where a frame is valid.
torch::Tensor Mask(const torch::Tensor& motion, const torch::Tensor& lengths) {
  return FrameMask(lengths, motion.size(1)).t().to(motion.scalar_type());
}

// Mean over the valid frames. Shapes: values, mask [N, T].
torch::Tensor FrameMean(const torch::Tensor& values, const torch::Tensor& mask) {
  return (values * mask).sum() / mask.sum().clamp_min(1);
}

// [N, T, 3 J] -> [N, T, J, 3]
torch::Tensor Joints(const torch::Tensor& motion) {
  return motion.reshape({motion.size(0), motion.size(1), -1, 3});
}

torch::Tensor Length(const torch::Tensor& vectors) {
  return vectors.square().sum(-1).clamp_min(kLengthFloor).sqrt();
}

// [N, T, B]
torch::Tensor BoneLengths(const torch::Tensor& motion, const std::vector<motion::Bone>& bones) {
  std::vector<int64_t> parents, children;
  for (const motion::Bone& bone : bones) {
    parents.push_back(bone.parent);
    children.push_back(bone.child);
  }
  const torch::Tensor joints = Joints(motion);
  return Length(joints.index_select(2, torch::tensor(children)) -
                joints.index_select(2, torch::tensor(parents)));
}

// [N, T - gap]: the sum of the distances that the joints move in `gap` frames.
torch::Tensor Moved(const torch::Tensor& motion, int64_t gap) {
  const torch::Tensor joints = Joints(motion);
  const int64_t frames = motion.size(1) - gap;
  return Length(joints.narrow(1, gap, frames) - joints.narrow(1, 0, frames)).sum(-1);
}

}  // namespace

torch::Tensor L1Loss(const torch::Tensor& predicted, const torch::Tensor& real,
                     const torch::Tensor& lengths) {
  return FrameMean((predicted - real).abs().sum(-1), Mask(real, lengths));
}

torch::Tensor NormLoss(const torch::Tensor& predicted, const torch::Tensor& real,
                       const torch::Tensor& lengths) {
  return FrameMean(Length(predicted - real), Mask(real, lengths));
}

torch::Tensor BoneLoss(const torch::Tensor& predicted, const torch::Tensor& real,
                       const torch::Tensor& lengths, const std::vector<motion::Bone>& bones) {
  // Bones of padding have length 0: divide by 1 instead.
  const torch::Tensor mask = Mask(real, lengths);
  const torch::Tensor wanted = BoneLengths(real, bones);
  const torch::Tensor divisor =
      torch::where(mask.unsqueeze(2) > 0, wanted, torch::ones_like(wanted));
  return FrameMean(((BoneLengths(predicted, bones) - wanted) / divisor).abs().sum(-1), mask);
}

torch::Tensor ContinuityLoss(const torch::Tensor& predicted, const torch::Tensor& lengths,
                             ContinuityForm form) {
  const torch::Tensor mask = Mask(predicted, lengths);
  const int64_t frames = predicted.size(1);
  if (form == ContinuityForm::kPathLength) {
    return FrameMean(Moved(predicted, 1), mask.narrow(1, 1, frames - 1));
  }
  constexpr int64_t kGap = 2;
  constexpr double kMargin = 0.1;  // metres
  if (frames <= kGap) return torch::zeros({}, predicted.options());
  const torch::Tensor near = Moved(predicted, 1).narrow(1, kGap - 1, frames - kGap);
  const torch::Tensor hinge = (near - Moved(predicted, kGap) + kMargin).clamp_min(0);
  return FrameMean(hinge, mask.narrow(1, kGap, frames - kGap));
}

torch::Tensor DiscriminatorLoss(const torch::Tensor& real_logits,
                                const torch::Tensor& synthesised_logits,
                                const torch::Tensor& classes) {
  const torch::Tensor synthesised = torch::full_like(classes, synthesised_logits.size(1) - 1);
  return F::cross_entropy(real_logits, classes) + F::cross_entropy(synthesised_logits, synthesised);
}

torch::Tensor AdversarialLoss(const torch::Tensor& synthesised_logits,
                              const torch::Tensor& classes) {
  return F::cross_entropy(synthesised_logits, classes);
}

}  // namespace duet::network
