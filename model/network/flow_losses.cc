#include "model/network/flow_losses.h"

#include "model/network/sequence.h"

namespace duet::network {
namespace {

constexpr double kSmallest = 1e-12;  // under a root, whose gradient at 0 is infinite

// Mean over the valid frames of one value each, [N, T].
torch::Tensor MeanOverFrames(const torch::Tensor& values, const torch::Tensor& lengths) {
  const torch::Tensor valid = FrameMask(lengths, values.size(1)).transpose(0, 1).to(values.dtype());
  return (values * valid).sum(1) / lengths.clamp_min(1);
}

torch::Tensor Differences(const torch::Tensor& motion) {
  return motion.slice(1, 1) - motion.slice(1, 0, -1);
}

torch::Tensor Joints(const torch::Tensor& motion) {
  return motion.view({motion.size(0), motion.size(1), -1, 3});
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
  const torch::Tensor parents = torch::tensor(from), children = torch::tensor(to);
  const torch::Tensor errors =
      BoneLengths(predicted, parents, children) - BoneLengths(real, parents, children);
  return MeanOverFrames(errors.square().mean(2), lengths);
}

torch::Tensor SquaredSlides(const torch::Tensor& predicted, const torch::Tensor& real,
                            const torch::Tensor& lengths, const motion::JointPair& feet,
                            double still) {
  const torch::Tensor both = torch::tensor({int64_t{feet.left}, int64_t{feet.right}});
  const auto moved = [&](const torch::Tensor& motion) {
    return Differences(Joints(motion).index_select(2, both)).square().sum(3);
  };
  const torch::Tensor stands = (moved(real) < still * still).to(predicted.dtype());
  return MeanOverFrames((moved(predicted) * stands).mean(2), lengths - 1);
}

}  // namespace duet::network
