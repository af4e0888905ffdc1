#ifndef DUET_MODEL_EVALUATION_PROGRAM_FOLD_JUDGE_H_
#define DUET_MODEL_EVALUATION_PROGRAM_FOLD_JUDGE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/judge/classifier.h"
#include "model/evaluation/metrics/judged_scores.h"

namespace duet::evaluation::program {

// The subjects to leave out in turn: those in `asked`, or, if it is empty, every subject of the
// data set. Errors: INVALID_ARGUMENT for a data set that names none.
absl::StatusOr<std::vector<std::string>> FoldSubjects(const dataset::Dataset& dataset,
                                                      const std::vector<std::string>& asked);

// Trains a fold's judge, only on the captured followers of the fold's training sequences. Prints
// the time to stderr. Errors: LeaveSubjectOut's, MotionClassifier::Train's.
absl::StatusOr<judge::MotionClassifier> TrainFoldJudge(const dataset::Dataset& dataset,
                                                       const std::string& subject);

// A judge's results for motions, each requested in its sequence's class.
metrics::JudgedFold JudgeMotions(const judge::MotionClassifier& judge,
                                 const dataset::Dataset& dataset,
                                 const std::vector<metrics::ScoredMotion>& motions);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_FOLD_JUDGE_H_
