#ifndef DUET_MODEL_EVALUATION_METRICS_JUDGED_SCORES_H_
#define DUET_MODEL_EVALUATION_METRICS_JUDGED_SCORES_H_

#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/metrics/features.h"

// Figures by class from the judges' results. Each fold has its own judge: features are comparable
// only within a fold.

namespace duet::evaluation::metrics {

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
