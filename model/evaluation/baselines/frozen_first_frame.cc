#include "model/evaluation/baselines/frozen_first_frame.h"

#include "absl/status/status.h"

namespace duet {

absl::Status FrozenFirstFrame::Train(const Dataset& dataset, const std::vector<int>& /*train*/) {
  skeleton_ = dataset.skeleton;
  return absl::OkStatus();
}

std::vector<Vec3> FrozenFirstFrame::Predict(const Sequence& sequence) const {
  const Vec3* first = sequence.pair.follower.frame(0);
  std::vector<Vec3> still;
  for (int t = 0; t < sequence.pair.leader.frame_count(); ++t) {
    still.insert(still.end(), first, first + skeleton_.joint_count());
  }
  return still;
}

}  // namespace duet
