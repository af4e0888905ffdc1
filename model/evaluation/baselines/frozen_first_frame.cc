#include "model/evaluation/baselines/frozen_first_frame.h"

#include <algorithm>

namespace duet::evaluation::baselines {

absl::Status FrozenFirstFrame::Train(const dataset::Dataset& /*dataset*/,
                                     const std::vector<int>& /*train*/) {
  return absl::OkStatus();
}

absl::StatusOr<motion::Poses> FrozenFirstFrame::Predict(const dataset::Sequence& sequence) const {
  const motion::Poses& first = sequence.pair.follower.poses;
  motion::Poses still(sequence.pair.leader.frame_count(), first.joint_count());
  for (int t = 0; t < still.frame_count(); ++t) {
    std::copy(first[0].begin(), first[0].end(), still[t].begin());
  }
  return still;
}

}  // namespace duet::evaluation::baselines
