#include "model/evaluation/metrics/judged_scores.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "model/evaluation/metrics/confusion.h"

namespace duet::evaluation::metrics {
namespace {

// Fewer motions have neither a covariance nor a pair.
constexpr size_t kLeastMotions = 2;

// A mean over the values that are not NaN.
class Mean {
 public:
  void Add(double value) {
    sum_ += value;
    ++count_;
  }
  double value() const {
    return count_ == 0 ? std::numeric_limits<double>::quiet_NaN() : sum_ / count_;
  }

 private:
  double sum_ = 0;
  int count_ = 0;
};

FeatureSet OfClass(const JudgedFold& fold, int wanted) {
  FeatureSet features;
  for (size_t i = 0; i < fold.classes.size(); ++i) {
    if (fold.classes[i] == wanted) features.push_back(fold.features[i]);
  }
  return features;
}

int MostLikely(const std::vector<float>& probabilities) {
  return static_cast<int>(std::max_element(probabilities.begin(), probabilities.end()) -
                          probabilities.begin());
}

}  // namespace

std::vector<double> AccuracyByClass(const std::vector<JudgedFold>& folds, int classes) {
  Confusion confusion(classes);
  for (const JudgedFold& fold : folds) {
    for (size_t i = 0; i < fold.classes.size(); ++i) {
      confusion.Add(fold.classes[i], MostLikely(fold.probabilities[i]));
    }
  }
  std::vector<double> accuracy;
  for (int c = 0; c < classes; ++c) accuracy.push_back(confusion.ClassAccuracy(c));
  return accuracy;
}

absl::StatusOr<std::vector<double>> FrechetByClass(const std::vector<JudgedFold>& made,
                                                   const std::vector<JudgedFold>& captured,
                                                   int classes) {
  std::vector<double> distances;
  for (int c = 0; c < classes; ++c) {
    Mean mean;
    for (size_t fold = 0; fold < made.size(); ++fold) {
      const FeatureSet a = OfClass(made[fold], c), b = OfClass(captured[fold], c);
      if (std::min(a.size(), b.size()) < kLeastMotions) continue;
      absl::StatusOr<double> distance = FrechetDistance(a, b);
      if (!distance.ok()) return distance.status();
      mean.Add(*distance);
    }
    distances.push_back(mean.value());
  }
  return distances;
}

absl::StatusOr<double> PooledFrechet(const std::vector<JudgedFold>& made,
                                     const std::vector<JudgedFold>& captured) {
  Mean mean;
  for (size_t fold = 0; fold < made.size(); ++fold) {
    const FeatureSet &a = made[fold].features, &b = captured[fold].features;
    if (std::min(a.size(), b.size()) < kLeastMotions) continue;
    absl::StatusOr<double> distance = FrechetDistance(a, b);
    if (!distance.ok()) return distance.status();
    mean.Add(*distance);
  }
  return mean.value();
}

std::vector<double> DiversityByClass(const std::vector<JudgedFold>& folds, int classes) {
  std::vector<double> diversities;
  for (int c = 0; c < classes; ++c) {
    Mean mean;
    for (const JudgedFold& fold : folds) {
      const FeatureSet features = OfClass(fold, c);
      if (features.size() >= kLeastMotions) mean.Add(Diversity(features));
    }
    diversities.push_back(mean.value());
  }
  return diversities;
}

}  // namespace duet::evaluation::metrics
