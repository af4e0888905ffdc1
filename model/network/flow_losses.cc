#include "model/network/flow_losses.h"

#include <cmath>

#include "model/network/sequence.h"

namespace duet::network {
namespace {

constexpr double kSmallest = 1e-12;  // under a root, whose gradient at 0 is infinite
constexpr double kSmallestSquare = 1e-6;
constexpr int64_t kBlockStride = 2;

// Mean over the valid frames of values [N, T].
torch::Tensor MeanOverFrames(const torch::Tensor& values, const torch::Tensor& lengths) {
  const torch::Tensor valid = FrameMask(lengths, values.size(1)).transpose(0, 1).to(values.dtype());
  return (values * valid).sum(1) / lengths.clamp_min(1);
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

// [..., T, J, 3] of a motion [..., T, 3 J].
torch::Tensor Joints(const torch::Tensor& motion) { return motion.unflatten(-1, {-1, 3}); }

// Joint indices, on the device of the motion that they select from.
torch::Tensor Indices(const std::vector<int64_t>& joints, const torch::Tensor& motion) {
  return torch::tensor(joints).to(motion.device());
}

torch::Tensor PairOf(const torch::Tensor& motion, const motion::JointPair& pair) {
  return Joints(motion).index_select(-2, Indices({pair.left, pair.right}, motion));
}

// Vectors whose length approaches 1 where they are much longer than `scale`.
torch::Tensor Saturated(const torch::Tensor& vectors, double scale) {
  return vectors / (vectors.square().sum(-1, true) + scale * scale).sqrt();
}

torch::Tensor BoneLengths(const torch::Tensor& motion, const torch::Tensor& parents,
                          const torch::Tensor& children) {
  const torch::Tensor joints = Joints(motion);
  const torch::Tensor along = joints.index_select(2, children) - joints.index_select(2, parents);
  return (along * along).sum(3).add(kSmallest).sqrt();
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
  std::vector<int64_t> from, to;
  for (const motion::Bone& bone : bones) {
    from.push_back(bone.parent);
    to.push_back(bone.child);
  }
  const torch::Tensor parents = Indices(from, real), children = Indices(to, real);
  const torch::Tensor errors =
      BoneLengths(predicted, parents, children) - BoneLengths(real, parents, children);
  return MeanOverFrames(errors.square().mean(2), lengths);
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
