#ifndef DUET_MODEL_EVALUATION_PROTOCOL_PROTOCOL_H_
#define DUET_MODEL_EVALUATION_PROTOCOL_PROTOCOL_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/metrics/scores.h"
#include "model/motion/poses.h"

namespace duet::evaluation::protocol {

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

// A method's answers in one fold.
struct FoldResult {
  std::vector<metrics::ScoredMotion> motions;  // one for each test sequence, in the split's order
  double train_seconds = 0;
  double predict_seconds = 0;
};

// Trains a method and answers the test sequences with it: leave one subject out, with
// dataset::LeaveSubjectOut's split. A sequence of two subjects is tested in both their folds, and
// counts in both. The method receives the leader, the class
// and the partner's direction of a sequence. The follower is removed before Predict, except for its
// first pose if the method needs it.
// Source: paper section 4 and the data set's customary protocol.
// Errors: Train's; Predict's, prefixed with the names of the method and the sequence; INTERNAL
// naming both when an answer has the wrong size or is not finite.
absl::StatusOr<FoldResult> RunFold(const dataset::Dataset& dataset, const dataset::Split& split,
                                   Method* method);

}  // namespace duet::evaluation::protocol

#endif  // DUET_MODEL_EVALUATION_PROTOCOL_PROTOCOL_H_
