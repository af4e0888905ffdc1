#ifndef DUET_MODEL_EVALUATION_PROTOCOL_METHOD_H_
#define DUET_MODEL_EVALUATION_PROTOCOL_METHOD_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
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

}  // namespace duet::evaluation::protocol

#endif  // DUET_MODEL_EVALUATION_PROTOCOL_METHOD_H_
