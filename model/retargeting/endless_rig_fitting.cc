#include "model/retargeting/endless_rig_fitting.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace duet::retargeting {
namespace {

constexpr double kBlockSeconds = 1;

int BlockFrames(double frame_rate_hz) {
  return std::max(1, static_cast<int>(std::lround(kBlockSeconds * frame_rate_hz)));
}

std::vector<Quaternion> WorldRotations(const Rig& rig, const RigPose& pose) {
  std::vector<Quaternion> world;
  for (std::size_t j = 0; j < rig.joints.size(); ++j) {
    const int parent = rig.joints[j].parent;
    const Quaternion local = pose.rotations[j];
    world.push_back(parent < 0 ? local : world[static_cast<std::size_t>(parent)] * local);
  }
  return world;
}

// From `a` (share 0) to `b` (share 1), joint by joint in the world. Both have the same positions.
RigPose Between(const Rig& rig, const RigPose& a, const RigPose& b, double share) {
  const std::vector<Quaternion> world_a = WorldRotations(rig, a), world_b = WorldRotations(rig, b);
  RigPose pose = a;
  std::vector<Quaternion> world;
  for (std::size_t j = 0; j < rig.joints.size(); ++j) {
    const int parent = rig.joints[j].parent;
    world.push_back(Slerp(world_a[j], world_b[j], share));
    pose.rotations[j] =
        parent < 0 ? world[j] : Inverse(world[static_cast<std::size_t>(parent)]) * world[j];
  }
  return pose;
}

}  // namespace

EndlessRigFitter::EndlessRigFitter(const motion::Skeleton& skeleton, const Rig& rig,
                                   double frame_rate_hz, double ankle_height_on_floor)
    : skeleton_(skeleton),
      rig_(rig),
      frame_rate_hz_(frame_rate_hz),
      ankle_height_(ankle_height_on_floor),
      block_(BlockFrames(frame_rate_hz)),
      older_(NewFitter()),
      younger_(NewFitter()) {}

int EndlessRigFitter::HistoryFrames(double frame_rate_hz) { return 2 * BlockFrames(frame_rate_hz); }

std::unique_ptr<RigFitter> EndlessRigFitter::NewFitter() const {
  return std::make_unique<RigFitter>(skeleton_, rig_, frame_rate_hz_, ankle_height_,
                                     BoneLengths::kRigs);
}

const RigPose& EndlessRigFitter::Fit(int frame, absl::Span<const motion::Vec3> positions) {
  const int since = frame % block_;
  if (since == 0) {
    older_ = std::exchange(younger_, NewFitter());
  }
  const RigPose& from = older_->Fit(positions);
  const RigPose& to = younger_->Fit(positions);
  pose_ = Between(rig_, from, to, static_cast<double>(since) / block_);
  return pose_;
}

}  // namespace duet::retargeting
