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

// What a method answered in one fold.
struct FoldResult {
  std::string subject;                         // who was left out
  std::vector<metrics::ScoredMotion> motions;  // one for each test sequence, in the split's order
  double train_seconds = 0;
  double predict_seconds = 0;
};

// Trains and tests once: the method sees nothing of the test sequences but their leaders and
// classes (and first poses, for methods that declare it: every later frame of the follower is
// replaced before Predict sees the sequence).
// Errors: Train's; INTERNAL naming method and sequence when an answer has the wrong size or is not
// finite.
absl::StatusOr<FoldResult> RunFold(const dataset::Dataset& dataset, const dataset::Split& split,
                                   const std::string& subject, Method* method);

// Leave one subject out, over `subjects` (empty: all of the data set). A sequence of two subjects
// is tested in both their folds, and counts in both. `done` (optional) hears of each fold. Source:
// paper section 4 and the data set's customary protocol.
absl::StatusOr<std::vector<FoldResult>> RunLeaveOneSubjectOut(
    const dataset::Dataset& dataset, std::vector<std::string> subjects, Method* method,
    const std::function<void(const FoldResult&)>& done = nullptr);

// All folds' motions together.
std::vector<metrics::ScoredMotion> PoolMotions(const std::vector<FoldResult>& folds);

}  // namespace duet::evaluation::protocol

#endif  // DUET_MODEL_EVALUATION_PROTOCOL_PROTOCOL_H_
