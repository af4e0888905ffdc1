#ifndef DUET_MODEL_EVALUATION_PROTOCOL_METHOD_H_
#define DUET_MODEL_EVALUATION_PROTOCOL_METHOD_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "model/dataset/dataset.h"

namespace duet::evaluation::protocol {

// A way to answer a leader: a row of the paper's Table 1. Each sees only what the protocol gives
// it.
class Method {
 public:
  virtual ~Method() = default;

  // Stable, lower_snake_case: the row's name in reports.
  virtual std::string name() const = 0;

  // Learns from the sequences `train` of the data set.
  virtual absl::Status Train(const dataset::Dataset& dataset, const std::vector<int>& train) = 0;

  // The follower's motion for a test sequence's leader and class: [frames, joints], world metres.
  // Must not read sequence.pair.follower, except for what reads_first_pose declares.
  virtual std::vector<motion::Vec3> Predict(const dataset::Sequence& sequence) const = 0;

  // True for methods that are told the follower's first pose.
  virtual bool reads_first_pose() const { return false; }
};

}  // namespace duet::evaluation::protocol

#endif  // DUET_MODEL_EVALUATION_PROTOCOL_METHOD_H_
