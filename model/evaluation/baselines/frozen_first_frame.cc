#include "model/evaluation/baselines/frozen_first_frame.h"

#include "absl/status/status.h"
#include "model/evaluation/baselines/motion_matrix.h"

namespace duet {

absl::Status FrozenFirstFrame::Train(const Dataset& dataset, const std::vector<int>& /*train*/) {
  skeleton_ = dataset.skeleton;
  return absl::OkStatus();
}

std::vector<Vec3> FrozenFirstFrame::Predict(const Sequence& sequence) const {
  const Standardisation frame = BaselineFrame(skeleton_, sequence);
  const Vec3* first = sequence.pair.follower.frame(0);
  const std::vector<Vec3> pose =
      frame.Apply(std::vector<Vec3>(first, first + skeleton_.joint_count()));
  std::vector<Vec3> still;
  for (int t = 0; t < sequence.pair.leader.frame_count(); ++t) {
    still.insert(still.end(), pose.begin(), pose.end());
  }
  return frame.Invert(still);
}

}  // namespace duet
