#include <torch/torch.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "model/motion/standardise.h"
#include "model/training/augment.h"
#include "model/training/finishing.h"

namespace duet::training {
namespace {

// Penalties on the squared coefficients, relative to the mean squared error: of those that all
// classes share, and of what a class adds to them.
constexpr double kPenalty = 0.03, kClassPenalty = 0.3;
// The correction learns to mend estimates that are off by these angles, radians.
constexpr double kErrors[] = {-0.4, 0, 0.4};
// Minimum deviation, metres: a feature that hardly varies in training has no influence.
constexpr double kSmallestDeviation = 1e-3;

// One leader: the features of the motion relative to a direction, and the partner's direction
// relative to it.
struct Sample {
  std::vector<double> features;
  double angle = 0;
  int interaction_class = 0;
};

void AddSample(const motion::Skeleton& skeleton, const dataset::Sequence& sequence,
               std::vector<Sample>* samples) {
  const motion::Poses& leader = sequence.pair.leader.poses;
  std::optional<std::vector<double>> features = engine::DirectionFeatures(skeleton, leader);
  if (!features || !sequence.partner_direction) return;
  const double hips = motion::Standardisation(skeleton, leader).yaw();
  const motion::Vec3 seen = RotateY(*sequence.partner_direction, hips);
  samples->push_back(
      {*std::move(features), std::atan2(seen.x, -seen.z), sequence.interaction_class});
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

// The same leader as it looks from a direction at `angle`.
Sample Turned(const Sample& sample, double angle) {
  return {engine::TurnedFeatures(sample.features, angle), sample.angle - angle,
          sample.interaction_class};
}

void MeasureScale(const std::vector<Sample>& samples, engine::AngleRegression* regression) {
  std::vector<std::vector<double>> rows;
  for (const Sample& sample : samples) rows.push_back(sample.features);
  const torch::Tensor features = Rows(rows);
  regression->mean = ToVector(features.mean(0));
  regression->deviation = ToVector(features.std(0, false).clamp_min(kSmallestDeviation));
  regression->mean.back() = 0;  // keeps the constant feature 1
  regression->deviation.back() = 1;
}

// The scaled features [samples, features], followed by the same for each class, which are 0 in
// samples of other classes.
torch::Tensor ClassedRows(const engine::AngleRegression& regression,
                          const std::vector<Sample>& samples, int classes) {
  std::vector<std::vector<double>> rows;
  for (const Sample& sample : samples) {
    std::vector<double> row = ScaledFeatures(regression, sample.features);
    const std::size_t count = row.size();
    row.resize(count * static_cast<std::size_t>(1 + classes), 0);
    const std::size_t own = count * static_cast<std::size_t>(1 + sample.interaction_class);
    if (classes > 0)
      std::copy_n(row.begin(), count, row.begin() + static_cast<std::ptrdiff_t>(own));
    rows.push_back(std::move(row));
  }
  return Rows(rows);
}

// Fits the coefficients of `regression` and returns what classes add to them. `classes`: 0 for
// none.
std::vector<engine::ClassCoefficients> Fit(const std::vector<Sample>& samples, int classes,
                                           engine::AngleRegression* regression) {
  MeasureScale(samples, regression);
  std::vector<std::vector<double>> targets;
  for (const Sample& sample : samples) {
    targets.push_back({std::cos(sample.angle), std::sin(sample.angle)});
  }
  const torch::Tensor features = ClassedRows(*regression, samples, classes);
  const int64_t count = static_cast<int64_t>(regression->mean.size());
  torch::Tensor penalty = torch::full({features.size(1)}, kClassPenalty, torch::kFloat64);
  penalty.slice(0, 0, count).fill_(kPenalty);
  penalty[count - 1] = 0;
  penalty *= static_cast<double>(samples.size());
  const torch::Tensor factors =
      torch::linalg_solve(torch::matmul(features.t(), features) + torch::diag(penalty),
                          torch::matmul(features.t(), Rows(targets)))
          .reshape({1 + classes, count, 2});
  regression->cosine = ToVector(factors.select(0, 0).select(1, 0));
  regression->sine = ToVector(factors.select(0, 0).select(1, 1));
  std::vector<engine::ClassCoefficients> added;
  for (int c = 0; c < classes; ++c) {
    const torch::Tensor own = factors.select(0, 1 + c);
    added.push_back({ToVector(own.select(1, 0)), ToVector(own.select(1, 1))});
  }
  return added;
}

}  // namespace

std::optional<engine::DirectionRegression> FitPartnerDirection(const dataset::Dataset& dataset,
                                                               const std::vector<int>& train) {
  const std::vector<Sample> samples = Samples(dataset, train);
  if (samples.empty()) return std::nullopt;
  engine::DirectionRegression regression;
  std::vector<Sample> either_way = samples;
  for (const Sample& sample : samples) either_way.push_back(Turned(sample, M_PI));
  Fit(either_way, 0, &regression);

  std::vector<Sample> mistaken;
  for (const Sample& sample : samples) {
    for (const double error : kErrors) mistaken.push_back(Turned(sample, sample.angle + error));
  }
  engine::DirectionCorrection& correction = regression.correction.emplace();
  correction.classes = Fit(mistaken, dataset.class_count(), &correction);
  return regression;
}

}  // namespace duet::training
