#include "model/evaluation/metrics/judged_scores.h"

#include <algorithm>
#include <cstddef>

#include "model/base/statistics.h"
#include "model/evaluation/metrics/confusion.h"

namespace duet::evaluation::metrics {
namespace {

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
    absl::StatusOr<double> distance = FrechetDistance(a, b);
    if (!distance.ok()) return distance.status();
    distances.push_back(*distance);
  }
  return base::Mean(distances);
}

}  // namespace

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
    absl::StatusOr<double> distance =
        MeanFrechet(made, captured, [c](const JudgedFold& fold) { return OfClass(fold, c); });
    if (!distance.ok()) return distance.status();
    distances.push_back(*distance);
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
