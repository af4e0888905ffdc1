#ifndef DUET_MODEL_EVALUATION_PROGRAM_FOLD_JUDGE_H_
#define DUET_MODEL_EVALUATION_PROGRAM_FOLD_JUDGE_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/judge/motion_classifier.h"
#include "model/evaluation/metrics/judged_scores.h"
#include "model/evaluation/metrics/scores.h"
#include "model/evaluation/program/experiment.h"

namespace duet::evaluation::program {

// Trains a fold's judge, only on the captured followers of the fold's training sequences. Prints
// the time to stderr. Errors: MotionClassifier::Train's.
absl::StatusOr<judge::MotionClassifier> TrainFoldJudge(const dataset::Dataset& dataset,
                                                       const Fold& fold);

// The judge's name and hash, for the settings of a section.
std::pair<std::string, std::string> JudgeSetting(const Fold& fold,
                                                 const judge::MotionClassifier& judge);

// A judge's results for motions, each requested in its sequence's class.
metrics::JudgedFold JudgeMotions(const judge::MotionClassifier& judge,
                                 const dataset::Dataset& dataset,
                                 const std::vector<metrics::ScoredMotion>& motions);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_FOLD_JUDGE_H_
