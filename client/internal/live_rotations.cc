#include "client/internal/live_rotations.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "absl/status/status.h"
#include "client/internal/rotation_conversion.h"

namespace duet::client::internal {
namespace {

constexpr char kRig[] = "frames.rig";

void KeepSign(const motion::UnitQuaternion& before, motion::UnitQuaternion* q) {
  if (before.x * q->x + before.y * q->y + before.z * q->z + before.w * q->w < 0) {
    *q = {-q->x, -q->y, -q->z, -q->w};
  }
}

}  // namespace

absl::StatusOr<std::optional<motion::JointRotations>> LiveRotations::Read(
    const v1::FollowerFrames& frames, int known) {
  const bool expects_rig = wanted_ && !has_rig_;
  if (frames.rig().empty() == expects_rig) {
    return absl::InvalidArgumentError(
        expects_rig
            ? "frames.rig: expected joints in the first frames of a stream, got none; does the "
              "server know reply_rotations?"
            : "frames.rig: expected joints only for rotations, in the first frames, got some");
  }
  if (expects_rig) {
    absl::StatusOr<std::vector<motion::RestJoint>> rig = ReadRig(kRig, frames.rig(), joint_count_);
    if (!rig.ok()) return rig.status();
    rig_ = *std::move(rig);
    has_rig_ = true;
  }
  absl::Status status =
      CheckRotations("frames.rotations", frames.rotations(), frames.frame_count(), rig_.size());
  if (!status.ok()) return status;
  if (!wanted_) return std::nullopt;
  motion::JointRotations read{rig_, {}};
  AppendRotations(frames.rotations(), &read.rotations);
  const auto width = static_cast<std::ptrdiff_t>(rig_.size());
  read.rotations.erase(read.rotations.begin(), read.rotations.begin() + known * width);
  if (read.rotations.empty()) return std::nullopt;
  if (last_.size() != rig_.size())
    last_.assign(read.rotations.begin(), read.rotations.begin() + width);
  for (std::size_t i = 0; i < read.rotations.size(); ++i) {
    const std::size_t joint = i % rig_.size();
    KeepSign(last_[joint], &read.rotations[i]);
    last_[joint] = read.rotations[i];
  }
  return read;
}

}  // namespace duet::client::internal
