#include "model/evaluation/metrics/judged_scores.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "model/base/statistics.h"

namespace duet::evaluation::metrics {
namespace {

double SquaredDistance(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double difference = double{a[i]} - double{b[i]};
    sum += difference * difference;
  }
  return sum;
}

// A Gaussian as its mean and a factor R with covariance R^T R.
struct Gaussian {
  Eigen::RowVectorXd mean;
  Eigen::MatrixXd factor;  // [min(samples, features), features]
};

Gaussian Fit(const FeatureSet& features) {
  const Eigen::Index samples = static_cast<Eigen::Index>(features.size());
  const Eigen::Index width = static_cast<Eigen::Index>(features[0].size());
  Eigen::MatrixXd rows(samples, width);
  for (Eigen::Index i = 0; i < samples; ++i) {
    rows.row(i) =
        Eigen::Map<const Eigen::RowVectorXf>(features[static_cast<size_t>(i)].data(), width)
            .cast<double>();
  }
  const Eigen::RowVectorXd mean = rows.colwise().mean();
  rows.rowwise() -= mean;
  rows /= std::sqrt(static_cast<double>(samples - 1));
  if (samples > width) {
    // rows = Q R: the same covariance with as many rows as features.
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows);
    rows = Eigen::MatrixXd(qr.matrixQR().topRows(width).triangularView<Eigen::Upper>());
  }
  return {mean, std::move(rows)};
}

// Fewer motions have neither a covariance nor a pair.
constexpr size_t kLeastMotions = 2;

FeatureSet OfClass(const JudgedFold& fold, int wanted) {
  FeatureSet features;
  for (size_t i = 0; i < fold.classes.size(); ++i) {
    if (fold.classes[i] == wanted) features.push_back(fold.features[i]);
  }
  return features;
}

// The mean over the folds whose two sets, selected by `select`, have enough motions.
template <typename Select>
double MeanFrechet(const std::vector<JudgedFold>& made, const std::vector<JudgedFold>& captured,
                   Select select) {
  std::vector<double> distances;
  for (size_t fold = 0; fold < made.size(); ++fold) {
    const FeatureSet a = select(made[fold]), b = select(captured[fold]);
    if (std::min(a.size(), b.size()) >= kLeastMotions) distances.push_back(FrechetDistance(a, b));
  }
  return base::Mean(distances);
}

}  // namespace

double FrechetDistance(const FeatureSet& a, const FeatureSet& b) {
  const Gaussian first = Fit(a), second = Fit(b);
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(first.factor * second.factor.transpose());
  const double distance = (first.mean - second.mean).squaredNorm() + first.factor.squaredNorm() +
                          second.factor.squaredNorm() - 2 * svd.singularValues().sum();
  return std::max(0.0, distance);
}

double Diversity(const FeatureSet& features) {
  double sum = 0, pairs = 0;
  for (size_t i = 0; i < features.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      sum += std::sqrt(SquaredDistance(features[i], features[j]));
      ++pairs;
    }
  }
  return pairs == 0 ? 0 : sum / pairs;
}

double NeighbourAccuracy(const FeatureSet& features, const std::vector<int>& classes) {
  if (features.size() < kLeastMotions) return NAN;
  double right = 0;
  for (size_t i = 0; i < features.size(); ++i) {
    size_t nearest = i == 0 ? 1 : 0;
    for (size_t other = 0; other < features.size(); ++other) {
      if (other != i && SquaredDistance(features[i], features[other]) <
                            SquaredDistance(features[i], features[nearest])) {
        nearest = other;
      }
    }
    if (classes[nearest] == classes[i]) ++right;
  }
  return right / static_cast<double>(features.size());
}

std::vector<double> ClassAccuracies(const std::vector<int>& meant,
                                    const std::vector<std::vector<float>>& probabilities,
                                    int classes) {
  std::vector<double> right(static_cast<size_t>(classes)), all(right.size());
  for (size_t i = 0; i < meant.size(); ++i) {
    const std::vector<float>& one = probabilities[i];
    const auto likeliest = std::max_element(one.begin(), one.end()) - one.begin();
    if (likeliest == meant[i]) ++right[static_cast<size_t>(meant[i])];
    ++all[static_cast<size_t>(meant[i])];
  }
  for (size_t c = 0; c < right.size(); ++c) right[c] /= all[c];
  return right;
}

std::vector<double> AccuracyByClass(const std::vector<JudgedFold>& folds, int classes) {
  JudgedFold all;
  for (const JudgedFold& fold : folds) {
    all.classes.insert(all.classes.end(), fold.classes.begin(), fold.classes.end());
    all.probabilities.insert(all.probabilities.end(), fold.probabilities.begin(),
                             fold.probabilities.end());
  }
  return ClassAccuracies(all.classes, all.probabilities, classes);
}

std::vector<double> FrechetByClass(const std::vector<JudgedFold>& made,
                                   const std::vector<JudgedFold>& captured, int classes) {
  std::vector<double> distances;
  for (int c = 0; c < classes; ++c) {
    distances.push_back(
        MeanFrechet(made, captured, [c](const JudgedFold& fold) { return OfClass(fold, c); }));
  }
  return distances;
}

double PooledFrechet(const std::vector<JudgedFold>& made, const std::vector<JudgedFold>& captured) {
  return MeanFrechet(made, captured, [](const JudgedFold& fold) { return fold.features; });
}

std::vector<double> DiversityByClass(const std::vector<JudgedFold>& folds, int classes) {
  std::vector<double> diversities;
  for (int c = 0; c < classes; ++c) {
    std::vector<double> of_folds;
    for (const JudgedFold& fold : folds) {
      const FeatureSet features = OfClass(fold, c);
      if (features.size() >= kLeastMotions) of_folds.push_back(Diversity(features));
    }
    diversities.push_back(base::Mean(of_folds));
  }
  return diversities;
}

}  // namespace duet::evaluation::metrics
