#include "model/evaluation/metrics/tsne.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "model/base/random.h"

namespace duet::evaluation::metrics {
namespace {

constexpr int kExaggeratedIterations = 250;
constexpr double kEarlyMomentum = 0.5, kLateMomentum = 0.8;
constexpr double kGainUp = 0.2, kGainDown = 0.8, kLeastGain = 0.01;
constexpr int kBisections = 60;
constexpr double kEntropyTolerance = 1e-6;
constexpr double kLeastAffinity = 1e-12;
constexpr double kStartSpread = 1e-4;

using Plane = Eigen::Matrix<double, Eigen::Dynamic, 2>;

absl::Status CheckSamples(const FeatureSet& features) {
  if (features.size() < 4) {
    return absl::InvalidArgumentError(
        absl::StrCat("features: ", features.size(), " samples, wanted at least 4"));
  }
  for (size_t i = 0; i < features.size(); ++i) {
    if (features[i].size() != features[0].size() || features[i].empty()) {
      return absl::InvalidArgumentError(absl::StrCat("features[", i, "]: ", features[i].size(),
                                                     " values, wanted as many as the first has"));
    }
    for (const float value : features[i]) {
      if (std::isfinite(value)) continue;
      return absl::InvalidArgumentError(
          absl::StrCat("features[", i, "]: not finite, wanted finite values"));
    }
  }
  return absl::OkStatus();
}

Eigen::MatrixXd SquaredDistances(const FeatureSet& features) {
  const Eigen::Index n = static_cast<Eigen::Index>(features.size());
  Eigen::MatrixXd rows(n, static_cast<Eigen::Index>(features[0].size()));
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::vector<float>& one = features[static_cast<size_t>(i)];
    rows.row(i) = Eigen::Map<const Eigen::RowVectorXf>(one.data(), rows.cols()).cast<double>();
  }
  // Distances do not change, and the products below stay small.
  rows.rowwise() -= rows.colwise().mean().eval();
  Eigen::MatrixXd squared = -2 * rows * rows.transpose();
  squared.colwise() += rows.rowwise().squaredNorm();
  squared.rowwise() += rows.rowwise().squaredNorm().transpose();
  squared = squared.cwiseMax(0);
  squared.diagonal().setZero();
  return squared;
}

// The neighbour probabilities of one sample at a precision, and their entropy in nats.
double Neighbours(const Eigen::VectorXd& squared, Eigen::Index self, double precision,
                  Eigen::VectorXd* probabilities) {
  *probabilities = (-precision * squared).array().exp();
  (*probabilities)(self) = 0;
  const double sum = probabilities->sum();
  const double entropy = std::log(sum) + precision * probabilities->dot(squared) / sum;
  *probabilities /= sum;
  return entropy;
}

// p_{j|i} with the entropy that the perplexity asks for, by bisection of the precision.
Eigen::VectorXd Calibrate(Eigen::VectorXd squared, Eigen::Index self, double perplexity) {
  // Relative to the nearest neighbour: the exponentials cannot all vanish.
  squared(self) = std::numeric_limits<double>::max();
  squared.array() -= squared.minCoeff();
  squared(self) = 0;
  const double wanted = std::log(perplexity);
  double low = 0, high = std::numeric_limits<double>::infinity(), precision = 1;
  Eigen::VectorXd probabilities;
  for (int i = 0; i < kBisections; ++i) {
    const double entropy = Neighbours(squared, self, precision, &probabilities);
    if (std::abs(entropy - wanted) < kEntropyTolerance) break;
    (entropy > wanted ? low : high) = precision;
    precision = std::isinf(high) ? 2 * precision : (low + high) / 2;
  }
  return probabilities;
}

// The joint probabilities of all pairs. Shapes: squared [n, n].
Eigen::MatrixXd Affinities(const Eigen::MatrixXd& squared, double perplexity) {
  Eigen::MatrixXd affinities(squared.rows(), squared.cols());
  for (Eigen::Index i = 0; i < squared.rows(); ++i) {
    affinities.col(i) = Calibrate(squared.col(i), i, perplexity);
  }
  const Eigen::MatrixXd both = affinities + affinities.transpose();
  return (both / both.sum()).cwiseMax(kLeastAffinity);
}

// The gradient of the Kullback-Leibler divergence from affinities to the map's Student-t ones.
Plane Gradient(const Eigen::MatrixXd& affinities, const Plane& map) {
  const Eigen::VectorXd norms = map.rowwise().squaredNorm();
  Eigen::MatrixXd kernel = -2 * map * map.transpose();
  kernel.colwise() += norms;
  kernel.rowwise() += norms.transpose();
  kernel = (1 + kernel.array()).inverse();
  kernel.diagonal().setZero();
  const double sum = kernel.sum();
  const Eigen::MatrixXd pull =
      (affinities.array() - (kernel.array() / sum).max(kLeastAffinity)) * kernel.array();
  const Eigen::VectorXd total = pull.rowwise().sum();
  return 4 * (total.asDiagonal() * map - pull * map);
}

Plane Embed(const Eigen::MatrixXd& affinities, double learning_rate, const TsneOptions& options) {
  base::Random random(options.seed);
  const Eigen::Index n = affinities.rows();
  Plane map(n, 2), velocity = Plane::Zero(n, 2), gains = Plane::Ones(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < 2; ++j) map(i, j) = kStartSpread * random.StandardNormal();
  }
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    const bool early = iteration < kExaggeratedIterations;
    const Plane gradient =
        early ? Gradient(options.exaggeration * affinities, map) : Gradient(affinities, map);
    // A coordinate that keeps its direction speeds up, one that turns back slows down.
    const auto turned = (gradient.array() > 0) == (velocity.array() > 0);
    gains = turned.select(gains.array() * kGainDown, gains.array() + kGainUp).max(kLeastGain);
    velocity = (early ? kEarlyMomentum : kLateMomentum) * velocity -
               learning_rate * gains.cwiseProduct(gradient);
    map += velocity;
    map.rowwise() -= map.colwise().mean().eval();
  }
  return map;
}

}  // namespace

absl::StatusOr<std::vector<Point2>> Tsne(const FeatureSet& features, const TsneOptions& options) {
  absl::Status status = CheckSamples(features);
  if (!status.ok()) return status;
  const double samples = static_cast<double>(features.size());
  const double most = (samples - 1) / 3;
  if (!(options.perplexity >= 1 && options.perplexity <= most)) {
    return absl::InvalidArgumentError(absl::StrCat("perplexity: ", options.perplexity,
                                                   ", wanted 1 to ", most, " for ", features.size(),
                                                   " samples"));
  }
  const double learning_rate = options.learning_rate > 0
                                   ? options.learning_rate
                                   : std::max(samples / options.exaggeration, 50.0);
  const Plane map =
      Embed(Affinities(SquaredDistances(features), options.perplexity), learning_rate, options);
  std::vector<Point2> points;
  for (Eigen::Index i = 0; i < map.rows(); ++i) points.push_back({map(i, 0), map(i, 1)});
  return points;
}

double NeighbourPurity(const std::vector<Point2>& points, const std::vector<int>& classes) {
  double same = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    size_t nearest = i;
    for (size_t j = 0; j < points.size(); ++j) {
      const double distance = std::hypot(points[i][0] - points[j][0], points[i][1] - points[j][1]);
      if (j == i || distance >= least) continue;
      least = distance;
      nearest = j;
    }
    if (classes[i] == classes[nearest]) ++same;
  }
  return same / static_cast<double>(points.size());
}

}  // namespace duet::evaluation::metrics
