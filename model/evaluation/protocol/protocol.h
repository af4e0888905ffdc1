#ifndef DUET_MODEL_EVALUATION_PROTOCOL_PROTOCOL_H_
#define DUET_MODEL_EVALUATION_PROTOCOL_PROTOCOL_H_

#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/metrics/scores.h"
#include "model/evaluation/protocol/method.h"

namespace duet::evaluation::protocol {

// A method's answers in one fold.
struct FoldResult {
  std::string subject;                         // the subject left out
  std::vector<metrics::ScoredMotion> motions;  // one for each test sequence, in the split's order
  double train_seconds = 0;
  double predict_seconds = 0;
};

// Trains a method and answers the test sequences with it. The method receives the leader, the class
// and the partner's direction of a sequence. The follower is removed before Predict, except for its
// first pose if the method needs it.
// Errors: Train's; Predict's, prefixed with the names of the method and the sequence; INTERNAL
// naming both when an answer has the wrong size or is not finite.
absl::StatusOr<FoldResult> RunFold(const dataset::Dataset& dataset, const dataset::Split& split,
                                   const std::string& subject, Method* method);

// Leave one subject out, over `subjects` (empty: all of the data set). A sequence of two subjects
// is tested in both their folds, and counts in both. `done`, if given, is called after each fold.
// Source: paper section 4 and the data set's customary protocol.
absl::StatusOr<std::vector<FoldResult>> RunLeaveOneSubjectOut(
    const dataset::Dataset& dataset, std::vector<std::string> subjects, Method* method,
    const std::function<void(const FoldResult&)>& done = nullptr);

// All folds' motions together.
std::vector<metrics::ScoredMotion> PoolMotions(const std::vector<FoldResult>& folds);

}  // namespace duet::evaluation::protocol

#endif  // DUET_MODEL_EVALUATION_PROTOCOL_PROTOCOL_H_
