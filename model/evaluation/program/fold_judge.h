#ifndef DUET_MODEL_EVALUATION_PROGRAM_FOLD_JUDGE_H_
#define DUET_MODEL_EVALUATION_PROGRAM_FOLD_JUDGE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/judge/classifier.h"
#include "model/evaluation/metrics/judged_scores.h"

namespace duet {

// Who is left out in turn: those asked for, or else every subject of the data set. Errors:
// INVALID_ARGUMENT for a data set that names none.
absl::StatusOr<std::vector<std::string>> FoldSubjects(const Dataset& dataset,
                                                      const std::vector<std::string>& asked);

// The captured followers of sequences of the data set, as a judge is trained on them.
std::vector<ScoredMotion> CapturedFollowers(const Dataset& dataset,
                                            const std::vector<int>& sequences);

// A classifier that has seen the captured followers of a fold's training sequences and no others.
// Tells stderr how long it took. Errors: LeaveSubjectOut's, MotionClassifier::Train's.
absl::StatusOr<MotionClassifier> TrainFoldJudge(const Dataset& dataset, const std::string& subject);

// What a judge makes of motions, each asked to be of its sequence's class.
JudgedFold Judge(const MotionClassifier& judge, const Dataset& dataset,
                 const std::vector<ScoredMotion>& motions);

}  // namespace duet

#endif  // DUET_MODEL_EVALUATION_PROGRAM_FOLD_JUDGE_H_
