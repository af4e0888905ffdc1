#ifndef DUET_MODEL_EVALUATION_METRICS_JUDGED_SCORES_H_
#define DUET_MODEL_EVALUATION_METRICS_JUDGED_SCORES_H_

#include <vector>

#include "absl/status/statusor.h"

// Distances between sets of feature vectors that a classifier computes of motions.
// Shapes: [samples][features].

namespace duet::evaluation::metrics {

using FeatureSet = std::vector<std::vector<float>>;

// Frechet distance of two Gaussians fitted to the sets (FID when the features are an extractor's):
// |mu1 - mu2|^2 + Tr(S1 + S2 - 2 (S1 S2)^(1/2)), covariances with divisor n - 1.
//
// Source: Heusel et al. 2017; paper section 4. Tr (S1 S2)^(1/2) is computed as the sum of the
// singular values of A1^T A2 with S = A A^T (A: the centred samples over sqrt(n - 1)): their
// squares are the eigenvalues of S1 S2. No square root of a rank-deficient matrix is taken, so sets
// with fewer samples than features give exact values, never complex or negative ones. Errors:
// INVALID_ARGUMENT for fewer than 2 samples, values that are not finite.
absl::StatusOr<double> FrechetDistance(const FeatureSet& a, const FeatureSet& b);

// The mean Euclidean distance over all pairs of different samples. 0 for fewer than 2.
double Diversity(const FeatureSet& features);

// The share of samples whose nearest other sample (Euclidean) is of their class: how well the
// classes are separated in the space itself. Shapes: features [samples][features], classes
// [samples]. Errors: INVALID_ARGUMENT for fewer than 2 samples.
absl::StatusOr<double> NeighbourAccuracy(const FeatureSet& features,
                                         const std::vector<int>& classes);

// Counts how often motions of one class were classified as another.
class Confusion {
 public:
  explicit Confusion(int classes);

  // Both in [0, classes).
  void Add(int meant, int taken_for);
  // Counts the likeliest class of each motion. Shapes: meant [motions], probabilities
  // [motions][classes].
  void AddLikeliest(const std::vector<int>& meant,
                    const std::vector<std::vector<float>>& probabilities);

  int count(int meant, int taken_for) const;
  // The share of a class's motions that were classified correctly; NaN without any.
  double ClassAccuracy(int meant) const;
  // ClassAccuracy of every class.
  std::vector<double> ClassAccuracies() const;
  // The share of all motions that were classified correctly; NaN without any.
  double Accuracy() const;
  // The mean of ClassAccuracy over the classes that have motions: all classes have equal weight.
  double MeanClassAccuracy() const;

 private:
  int Total(int meant) const;

  int classes_;
  std::vector<int> counts_;  // [actual, predicted]
};

// Figures by class from the judges' results. Each fold has its own judge: features are comparable
// only within a fold.

// The results of a fold's judge for the fold's motions.
struct JudgedFold {
  std::vector<int> classes;                       // [motions], the requested classes
  std::vector<std::vector<float>> probabilities;  // [motions][classes]
  FeatureSet features;                            // [motions][features]
};

// The share of each class's motions, over all folds, that their fold's judge assigns to that class;
// NaN for a class without any. Shapes: returns [classes].
std::vector<double> AccuracyByClass(const std::vector<JudgedFold>& folds, int classes);

// The Frechet distance between synthesised and captured motions of each class within a fold,
// averaged over the folds with at least 2 motions of it on both sides; NaN without such a fold.
// Shapes: made and captured [folds]; returns [classes]. Errors: FrechetDistance's.
absl::StatusOr<std::vector<double>> FrechetByClass(const std::vector<JudgedFold>& made,
                                                   const std::vector<JudgedFold>& captured,
                                                   int classes);

// The Frechet distance between a fold's synthesised and captured motions of all classes together,
// averaged over the folds with at least 2 motions on both sides; NaN without such a fold. A fold
// has too few motions of one class to estimate their spread.
// Shapes: made and captured [folds]. Errors: FrechetDistance's.
absl::StatusOr<double> PooledFrechet(const std::vector<JudgedFold>& made,
                                     const std::vector<JudgedFold>& captured);

// The mean distance between motions of a class within a fold, averaged likewise.
std::vector<double> DiversityByClass(const std::vector<JudgedFold>& folds, int classes);

}  // namespace duet::evaluation::metrics

#endif  // DUET_MODEL_EVALUATION_METRICS_JUDGED_SCORES_H_
