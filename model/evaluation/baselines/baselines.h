#ifndef DUET_MODEL_EVALUATION_BASELINES_BASELINES_H_
#define DUET_MODEL_EVALUATION_BASELINES_BASELINES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/metrics/scores.h"

namespace duet::evaluation::baselines {

// The two trivial rows, then the rows of Table 1 that need no network, in the order of the table.
std::vector<std::string> BaselineNames();

// Trains a baseline with its published settings (docs/baselines.md) on the training sequences of a
// split, and answers the test sequences. It receives the leader, the class and the partner's
// direction of a sequence; "frozen_first_frame" also the follower's first pose. Source: paper
// section 4. Requires a name of BaselineNames. Shapes: returns [test], in the split's order.
// Errors: INVALID_ARGUMENT for a class without a training sequence; INTERNAL naming baseline and
// sequence if an answer is not finite.
absl::StatusOr<std::vector<metrics::ScoredMotion>> RunBaseline(const std::string& name,
                                                               const dataset::Dataset& dataset,
                                                               const dataset::Split& split);

// For each test sequence, returns the captured follower of a random training sequence with the same
// class (`seed`), placed as it stood to its own leader in the first frame. Drawn among clips that
// are at least as long as the leader and cut to its length; if there are none, stretched. This is
// real motion of people who did not see the leader: its figures bound measures of similarity
// between different people. It is not synchronised with the leader.
//
// Shapes: returns [test]. Errors: INVALID_ARGUMENT for a class without a training sequence.
absl::StatusOr<std::vector<metrics::ScoredMotion>> AnswerWithOtherPeople(
    const dataset::Dataset& dataset, const dataset::Split& split, uint64_t seed);

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_BASELINES_H_
