#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_TOLD_APART_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_TOLD_APART_H_

#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/judge/classifier.h"
#include "model/evaluation/metrics/scores.h"

namespace duet::evaluation::experiments {

// What told-apart classifiers are trained with. They see leader and follower, and less is done to
// make them work for other builds than for a judge: a limb of a wrong length may give an answer
// away.
judge::ClassifierOptions ToldApartOptions(uint64_t seed);

// How well a fresh classifier tells synthesised followers from captured ones: the mean of the
// shares of captured and of synthesised pairs that it takes for what they are. 0.5: not at all; 1:
// always. It learns from answers to the training sequences and from the captured followers of the
// same, and is tested likewise on the test sequences. Leaders and followers all go through the same
// filter (WithoutNoise): it is not to find the capture's noise. Errors: INVALID_ARGUMENT without
// training or test answers.
absl::StatusOr<double> ToldApart(const dataset::Dataset& dataset,
                                 const std::vector<metrics::ScoredMotion>& training_answers,
                                 const std::vector<metrics::ScoredMotion>& test_answers,
                                 const judge::ClassifierOptions& options);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_TOLD_APART_H_
