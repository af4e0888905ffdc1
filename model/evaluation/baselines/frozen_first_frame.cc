#include "model/evaluation/baselines/frozen_first_frame.h"

#include "absl/status/status.h"

namespace duet::evaluation::baselines {

absl::Status FrozenFirstFrame::Train(const dataset::Dataset& dataset,
                                     const std::vector<int>& /*train*/) {
  skeleton_ = dataset.skeleton;
  return absl::OkStatus();
}

std::vector<motion::Vec3> FrozenFirstFrame::Predict(const dataset::Sequence& sequence) const {
  const motion::Vec3* first = sequence.pair.follower.frame(0);
  std::vector<motion::Vec3> still;
  for (int t = 0; t < sequence.pair.leader.frame_count(); ++t) {
    still.insert(still.end(), first, first + skeleton_.joint_count());
  }
  return still;
}

}  // namespace duet::evaluation::baselines
