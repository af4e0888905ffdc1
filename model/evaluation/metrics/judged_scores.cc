#include "model/evaluation/metrics/judged_scores.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "model/base/statistics.h"
#include "model/base/status_macros.h"

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

absl::Status CheckFeatures(const char* set, const FeatureSet& features) {
  if (features.size() < 2) {
    return absl::InvalidArgumentError(
        absl::StrCat("features ", set, ": expected at least 2 samples, got ", features.size()));
  }
  for (size_t i = 0; i < features.size(); ++i) {
    if (!std::all_of(features[i].begin(), features[i].end(),
                     [](float value) { return std::isfinite(value); })) {
      return absl::InvalidArgumentError(
          absl::StrCat("features ", set, "[", i, "]: expected finite values, got others"));
    }
  }
  return absl::OkStatus();
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
absl::StatusOr<double> MeanFrechet(const std::vector<JudgedFold>& made,
                                   const std::vector<JudgedFold>& captured, Select select) {
  std::vector<double> distances;
  for (size_t fold = 0; fold < made.size(); ++fold) {
    const FeatureSet a = select(made[fold]), b = select(captured[fold]);
    if (std::min(a.size(), b.size()) < kLeastMotions) continue;
    DUET_TRY(distances.emplace_back(), FrechetDistance(a, b));
  }
  return base::Mean(distances);
}

}  // namespace

absl::StatusOr<double> FrechetDistance(const FeatureSet& a, const FeatureSet& b) {
  DUET_RETURN_IF_ERROR(CheckFeatures("a", a));
  DUET_RETURN_IF_ERROR(CheckFeatures("b", b));
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

absl::StatusOr<double> NeighbourAccuracy(const FeatureSet& features,
                                         const std::vector<int>& classes) {
  if (features.size() < 2) {
    return absl::InvalidArgumentError(
        absl::StrCat("features: expected at least 2 vectors, got ", features.size()));
  }
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

Confusion::Confusion(int classes)
    : classes_(classes), counts_(static_cast<size_t>(classes) * static_cast<size_t>(classes)) {}

void Confusion::Add(int meant, int taken_for) {
  ++counts_[static_cast<size_t>(meant * classes_ + taken_for)];
}

void Confusion::AddLikeliest(const std::vector<int>& meant,
                             const std::vector<std::vector<float>>& probabilities) {
  for (size_t i = 0; i < meant.size(); ++i) {
    const std::vector<float>& one = probabilities[i];
    Add(meant[i], static_cast<int>(std::max_element(one.begin(), one.end()) - one.begin()));
  }
}

int Confusion::count(int meant, int taken_for) const {
  return counts_[static_cast<size_t>(meant * classes_ + taken_for)];
}

int Confusion::Total(int meant) const {
  int total = 0;
  for (int i = 0; i < classes_; ++i) total += count(meant, i);
  return total;
}

double Confusion::ClassAccuracy(int meant) const {
  return static_cast<double>(count(meant, meant)) / Total(meant);
}

std::vector<double> Confusion::ClassAccuracies() const {
  std::vector<double> accuracies;
  for (int c = 0; c < classes_; ++c) accuracies.push_back(ClassAccuracy(c));
  return accuracies;
}

double Confusion::Accuracy() const {
  int right = 0, total = 0;
  for (int i = 0; i < classes_; ++i) {
    right += count(i, i);
    total += Total(i);
  }
  return static_cast<double>(right) / total;
}

double Confusion::MeanClassAccuracy() const { return base::Mean(ClassAccuracies()); }

std::vector<double> AccuracyByClass(const std::vector<JudgedFold>& folds, int classes) {
  Confusion confusion(classes);
  for (const JudgedFold& fold : folds) confusion.AddLikeliest(fold.classes, fold.probabilities);
  return confusion.ClassAccuracies();
}

absl::StatusOr<std::vector<double>> FrechetByClass(const std::vector<JudgedFold>& made,
                                                   const std::vector<JudgedFold>& captured,
                                                   int classes) {
  std::vector<double> distances;
  for (int c = 0; c < classes; ++c) {
    const auto select = [c](const JudgedFold& fold) { return OfClass(fold, c); };
    DUET_TRY(distances.emplace_back(), MeanFrechet(made, captured, select));
  }
  return distances;
}

absl::StatusOr<double> PooledFrechet(const std::vector<JudgedFold>& made,
                                     const std::vector<JudgedFold>& captured) {
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
