#ifndef DUET_MODEL_EVALUATION_BASELINES_FROZEN_FIRST_FRAME_H_
#define DUET_MODEL_EVALUATION_BASELINES_FROZEN_FIRST_FRAME_H_

#include <string>
#include <vector>

#include "model/evaluation/protocol/method.h"

namespace duet::evaluation::baselines {

// The trivial method with the follower's first pose: holds that pose still.
class FrozenFirstFrame : public protocol::Method {
 public:
  std::string name() const override { return "frozen_first_frame"; }
  absl::Status Train(const dataset::Dataset& dataset, const std::vector<int>& train) override;
  absl::StatusOr<motion::Poses> Predict(const dataset::Sequence& sequence) const override;
  bool reads_first_pose() const override { return true; }
};

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_FROZEN_FIRST_FRAME_H_
