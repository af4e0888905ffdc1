#include "model/network/losses.h"

#include <cmath>

#include "model/network/recurrent.h"

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

// [..., T, 3 J] -> [..., T, J, 3]
torch::Tensor Joints(const torch::Tensor& motion) { return motion.unflatten(-1, {-1, 3}); }

torch::Tensor Length(const torch::Tensor& vectors) {
  return vectors.square().sum(-1).clamp_min(kLengthFloor).sqrt();
}

// Joint indices, on the device of the motion that they select from.
torch::Tensor Indices(const std::vector<int64_t>& joints, const torch::Tensor& motion) {
  return torch::tensor(joints).to(motion.device());
}

// [N, T, B, 3]
torch::Tensor BoneVectors(const torch::Tensor& motion, const std::vector<motion::Bone>& bones) {
  std::vector<int64_t> parents, children;
  for (const motion::Bone& bone : bones) {
    parents.push_back(bone.parent);
    children.push_back(bone.child);
  }
  const torch::Tensor joints = Joints(motion);
  return joints.index_select(2, Indices(children, motion)) -
         joints.index_select(2, Indices(parents, motion));
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
  const torch::Tensor wanted = Length(BoneVectors(real, bones));
  const torch::Tensor divisor =
      torch::where(mask.unsqueeze(2) > 0, wanted, torch::ones_like(wanted));
  return FrameMean(((Length(BoneVectors(predicted, bones)) - wanted) / divisor).abs().sum(-1),
                   mask);
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

namespace {

constexpr double kSmallest = 1e-12;  // under a root, whose gradient at 0 is infinite
constexpr double kSmallestSquare = 1e-6;
constexpr int64_t kBlockStride = 2;

// Mean over the valid frames of values [N, T].
torch::Tensor MeanOverFrames(const torch::Tensor& values, const torch::Tensor& lengths) {
  return (values * Mask(values, lengths)).sum(1) / lengths.clamp_min(1);
}

// Differences along the frames, the second-to-last dimension.
torch::Tensor Differences(const torch::Tensor& motion) {
  return motion.slice(-2, 1) - motion.slice(-2, 0, -1);
}

torch::Tensor Norms(const torch::Tensor& vectors) {
  return vectors.square().sum(-1).add(kSmallestSquare).sqrt();
}

// [..., B, V frames]: the blocks of a motion [..., T, V].
torch::Tensor Blocks(const torch::Tensor& motion, int64_t frames) {
  const torch::Tensor blocks = motion.unfold(-2, frames, kBlockStride).flatten(-2);
  return blocks / std::sqrt(static_cast<double>(frames));
}

torch::Tensor PairOf(const torch::Tensor& motion, const motion::JointPair& pair) {
  return Joints(motion).index_select(-2, Indices({pair.left, pair.right}, motion));
}

// Vectors whose length approaches 1 where they are much longer than `scale`.
torch::Tensor Saturated(const torch::Tensor& vectors, double scale) {
  return vectors / (vectors.square().sum(-1, true) + scale * scale).sqrt();
}

}  // namespace

torch::Tensor SquaredErrors(const torch::Tensor& predicted, const torch::Tensor& real,
                            const torch::Tensor& lengths) {
  return MeanOverFrames((predicted - real).square().mean(2), lengths);
}

torch::Tensor SquaredDifferenceErrors(const torch::Tensor& predicted, const torch::Tensor& real,
                                      const torch::Tensor& lengths) {
  return SquaredErrors(Differences(predicted), Differences(real), lengths - 1);
}

torch::Tensor SquaredBoneErrors(const torch::Tensor& predicted, const torch::Tensor& real,
                                const torch::Tensor& lengths,
                                const std::vector<motion::Bone>& bones) {
  const auto lengths_of = [&](const torch::Tensor& motion) {
    return BoneVectors(motion, bones).square().sum(3).add(kSmallest).sqrt();
  };
  return MeanOverFrames((lengths_of(predicted) - lengths_of(real)).square().mean(2), lengths);
}

torch::Tensor EnergyScores(const torch::Tensor& answers, const torch::Tensor& real,
                           const torch::Tensor& lengths) {
  const int64_t count = answers.size(0);
  const torch::Tensor error = Norms(answers - real).mean(0);
  torch::Tensor spread = torch::zeros_like(error);
  for (int64_t a = 1; a < count; ++a) {
    for (int64_t b = 0; b < a; ++b) spread = spread + Norms(answers[a] - answers[b]);
  }
  const double pairs = static_cast<double>(count * (count - 1) / 2);
  return MeanOverFrames(error - spread / (2 * pairs), lengths);
}

torch::Tensor VelocityEnergyScores(const torch::Tensor& answers, const torch::Tensor& real,
                                   const torch::Tensor& lengths) {
  return EnergyScores(Differences(answers), Differences(real), lengths - 1);
}

torch::Tensor BlockEnergyScores(const torch::Tensor& answers, const torch::Tensor& real,
                                const torch::Tensor& lengths, int64_t frames) {
  const torch::Tensor moves = Differences(answers), real_moves = Differences(real);
  if (real_moves.size(1) < frames) return torch::zeros({real.size(0)}, real.options());
  const torch::Tensor blocks =
      torch::div(lengths - 1 - frames, kBlockStride, "floor").add(1).clamp_min(0);
  return EnergyScores(Blocks(moves, frames), Blocks(real_moves, frames), blocks);
}

torch::Tensor FootMotions(const torch::Tensor& motion, const motion::JointPair& feet,
                          double still) {
  const torch::Tensor moved = Differences(PairOf(motion, feet).flatten(-2)).unflatten(-1, {-1, 3});
  return Saturated(moved, still).flatten(-2);
}

torch::Tensor HandPlaces(const torch::Tensor& follower, const torch::Tensor& leader,
                         const motion::JointPair& hands, double near) {
  const torch::Tensor between =
      PairOf(follower, hands).unsqueeze(-2) - PairOf(leader, hands).unsqueeze(-3);
  return Saturated(between, near).flatten(-3);
}

}  // namespace duet::network
