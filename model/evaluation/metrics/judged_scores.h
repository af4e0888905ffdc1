#ifndef DUET_MODEL_EVALUATION_METRICS_JUDGED_SCORES_H_
#define DUET_MODEL_EVALUATION_METRICS_JUDGED_SCORES_H_

#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/metrics/features.h"

// Figures by class of what the judges make of motions. Each fold has a judge of its own, so that
// features may be compared within a fold only.

namespace duet::evaluation::metrics {

// What a fold's judge makes of the fold's motions.
struct JudgedFold {
  std::vector<int> classes;                       // [motions], what each was asked to be
  std::vector<std::vector<float>> probabilities;  // [motions][classes]
  FeatureSet features;                            // [motions][features]
};

// The share of each class's motions, over all folds, that their fold's judge takes for that class;
// NaN for a class without any. Shapes: returns [classes].
std::vector<double> AccuracyByClass(const std::vector<JudgedFold>& folds, int classes);

// The Frechet distance between synthesised and captured motions of each class within a fold,
// averaged over the folds that have 2 motions of it or more on both sides; NaN where none has.
// Shapes: made and captured [folds]; returns [classes]. Errors: FrechetDistance's.
absl::StatusOr<std::vector<double>> FrechetByClass(const std::vector<JudgedFold>& made,
                                                   const std::vector<JudgedFold>& captured,
                                                   int classes);

// The Frechet distance between a fold's synthesised and captured motions of all classes together,
// averaged over the folds that have 2 motions or more on both sides; NaN where none has. A fold has
// few motions of one class, of all of them enough to see how they spread.
// Shapes: made and captured [folds]. Errors: FrechetDistance's.
absl::StatusOr<double> PooledFrechet(const std::vector<JudgedFold>& made,
                                     const std::vector<JudgedFold>& captured);

// The mean distance between motions of a class within a fold, averaged likewise.
std::vector<double> DiversityByClass(const std::vector<JudgedFold>& folds, int classes);

}  // namespace duet::evaluation::metrics

#endif  // DUET_MODEL_EVALUATION_METRICS_JUDGED_SCORES_H_
