#ifndef DUET_MODEL_EVALUATION_BASELINES_BASELINES_H_
#define DUET_MODEL_EVALUATION_BASELINES_BASELINES_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/metrics/scores.h"
#include "model/motion/poses.h"

namespace duet::evaluation::baselines {

// A method that answers leaders: a row of the paper's Table 1.
class Method {
 public:
  virtual ~Method() = default;

  // Stable, lower_snake_case: the row's name in reports.
  virtual std::string name() const = 0;

  // Learns from the sequences `train` of the data set.
  virtual absl::Status Train(const dataset::Dataset& dataset, const std::vector<int>& train) = 0;

  // The follower's motion for a test sequence's leader, class and partner direction, in world
  // metres. The sequence has no follower, or only the follower's first pose if
  // reads_first_pose() is true. Shapes: returns as many frames as the leader has.
  virtual absl::StatusOr<motion::Poses> Predict(const dataset::Sequence& sequence) const = 0;

  // True for methods that receive the follower's first pose.
  virtual bool reads_first_pose() const { return false; }
};

// Trains a method and answers the test sequences with it: leave one subject out, with
// dataset::LeaveSubjectOut's split. A sequence of two subjects is tested in both their folds, and
// counts in both. The method receives the leader, the class and the partner's direction of a
// sequence. The follower is removed before Predict, except for its first pose if the method needs
// it. Source: paper section 4 and the data set's customary protocol.
// Shapes: returns [test], in the split's order.
// Errors: Train's; Predict's, prefixed with the names of the method and the sequence; INTERNAL
// naming both when an answer has the wrong size or is not finite.
absl::StatusOr<std::vector<metrics::ScoredMotion>> RunFold(const dataset::Dataset& dataset,
                                                           const dataset::Split& split,
                                                           Method* method);

// The two trivial rows, then the rows of Table 1 that need no network, in the order of the table.
std::vector<std::string> BaselineNames();

// A baseline by its name, untrained, with its published settings (docs/baselines.md). Its training
// discards the results of an earlier one, and fails with INVALID_ARGUMENT for a class of the data
// set without a training sequence. Errors: INVALID_ARGUMENT for a name that is not in
// BaselineNames.
absl::StatusOr<std::unique_ptr<Method>> MakeBaseline(const std::string& name);

// For each sequence of `test`, returns the captured follower of a random sequence of `train` with
// the same class (`seed`), placed as it stood to its own leader in the first frame. Drawn among
// clips that are at least as long as the leader and cut to its length; if there are none,
// stretched. This is real motion of people who did not see the leader: its figures bound measures
// of similarity between different people. It is not synchronised with the leader.
//
// Shapes: returns [test]. Errors: INVALID_ARGUMENT for a class without a training sequence.
absl::StatusOr<std::vector<motion::Poses>> AnswerWithOtherPeople(const dataset::Dataset& dataset,
                                                                 const std::vector<int>& train,
                                                                 const std::vector<int>& test,
                                                                 uint64_t seed);

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_BASELINES_H_
