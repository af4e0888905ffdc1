#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_TOLD_APART_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_TOLD_APART_H_

#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/judge/motion_classifier.h"
#include "model/evaluation/metrics/scores.h"

namespace duet::evaluation::experiments {

// Settings of told-apart classifiers. They see leader and follower, and vary people's proportions
// less than a judge does, since a limb of a wrong length may identify an answer.
judge::MotionClassifierOptions ToldApartOptions(uint64_t seed);

// The balanced accuracy of a new classifier that distinguishes synthesised from captured pairs.
// 0.5: indistinguishable; 1: always correct. It learns from answers to the training sequences and
// from their captured followers, and is tested on the same of the test sequences. Leaders and
// followers all pass the same filter (WithoutNoise), so that it cannot detect sensor noise. Errors:
// INVALID_ARGUMENT without training or test answers.
absl::StatusOr<double> ToldApart(const dataset::Dataset& dataset,
                                 const std::vector<metrics::ScoredMotion>& training_answers,
                                 const std::vector<metrics::ScoredMotion>& test_answers,
                                 const judge::MotionClassifierOptions& options);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_TOLD_APART_H_
