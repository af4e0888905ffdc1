#include "model/training/direction_fit.h"

#include <torch/torch.h>

#include <algorithm>
#include <utility>

#include "model/dataset/partner_direction.h"
#include "model/motion/standardise.h"
#include "model/training/augment.h"

namespace duet::training {
namespace {

// Penalty on the squared coefficients, relative to the mean squared error.
constexpr double kPenalty = 0.03;
// Minimum deviation, metres: a feature that hardly varies in training has no influence.
constexpr double kSmallestDeviation = 1e-3;

// One leader: the features of the motion, and the partner's direction relative to the hips'.
struct Sample {
  std::vector<double> features;
  double cosine = 0, sine = 0;
};

void AddSample(const motion::Skeleton& skeleton, const dataset::Sequence& sequence,
               std::vector<Sample>* samples) {
  const motion::Poses& leader = sequence.pair.leader.poses;
  std::optional<std::vector<double>> features = engine::DirectionFeatures(skeleton, leader);
  const motion::Vec3 toward = dataset::PartnerDirection(skeleton, sequence);
  if (!features || Norm(toward) == 0) return;
  const double hips = motion::Standardisation(skeleton, leader).yaw();
  const motion::Vec3 seen = RotateY(toward / Norm(toward), hips);
  samples->push_back({*std::move(features), -seen.z, seen.x});
}

std::vector<Sample> Samples(const dataset::Dataset& dataset, const std::vector<int>& train) {
  const std::vector<int> mirrored = MirroredJoints(dataset.skeleton);
  std::vector<Sample> samples;
  const auto add_both = [&](dataset::Sequence sequence) {
    AddSample(dataset.skeleton, sequence, &samples);
    Mirror(mirrored, &sequence);
    AddSample(dataset.skeleton, sequence, &samples);
  };
  for (const int index : train) {
    dataset::Sequence sequence = dataset.sequences[static_cast<size_t>(index)];
    add_both(sequence);
    if (!dataset.symmetric[static_cast<size_t>(sequence.interaction_class)]) continue;
    SwapRoles(&sequence);
    add_both(std::move(sequence));
  }
  return samples;
}

torch::Tensor Rows(const std::vector<std::vector<double>>& rows) {
  std::vector<torch::Tensor> tensors;
  for (const std::vector<double>& row : rows) {
    tensors.push_back(torch::tensor(row, torch::kFloat64));
  }
  return torch::stack(tensors);
}

std::vector<double> ToVector(const torch::Tensor& tensor) {
  const torch::Tensor values = tensor.contiguous();
  return {values.data_ptr<double>(), values.data_ptr<double>() + values.numel()};
}

void MeasureScale(const std::vector<Sample>& samples, engine::DirectionRegression* regression) {
  std::vector<std::vector<double>> rows;
  for (const Sample& sample : samples) rows.push_back(sample.features);
  const torch::Tensor features = Rows(rows);
  regression->mean = ToVector(features.mean(0));
  regression->deviation = ToVector(features.std(0, false).clamp_min(kSmallestDeviation));
  regression->mean.back() = 0;  // keeps the constant feature 1
  regression->deviation.back() = 1;
}

}  // namespace

std::optional<engine::DirectionRegression> FitPartnerDirection(const dataset::Dataset& dataset,
                                                               const std::vector<int>& train) {
  const std::vector<Sample> samples = Samples(dataset, train);
  if (samples.empty()) return std::nullopt;
  engine::DirectionRegression regression;
  MeasureScale(samples, &regression);
  std::vector<std::vector<double>> rows, targets;
  for (const Sample& sample : samples) {
    rows.push_back(ScaledFeatures(regression, sample.features));
    targets.push_back({sample.cosine, sample.sine});
  }
  const torch::Tensor features = Rows(rows);
  torch::Tensor penalty = torch::full(
      {features.size(1)}, kPenalty * static_cast<double>(samples.size()), torch::kFloat64);
  penalty[-1] = 0;
  const torch::Tensor factors =
      torch::linalg_solve(torch::matmul(features.t(), features) + torch::diag(penalty),
                          torch::matmul(features.t(), Rows(targets)));
  regression.cosine = ToVector(factors.select(1, 0));
  regression.sine = ToVector(factors.select(1, 1));
  return regression;
}

}  // namespace duet::training
