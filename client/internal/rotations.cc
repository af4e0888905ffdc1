#include "client/internal/rotations.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "model/base/text.h"

namespace duet::client::internal {
namespace {

// Of the norm from 1; rounding to float gives 1e-7.
constexpr float kNormTolerance = 1e-3F;

template <typename... Parts>
absl::Status Invalid(const Parts&... parts) {
  return absl::InvalidArgumentError(absl::StrCat(parts...));
}

absl::Status CheckJoint(const std::string& field, const v1::RigJoint& joint, int index,
                        int joint_count) {
  const bool has_parent =
      index == 0 ? joint.parent() == -1 : joint.parent() >= 0 && joint.parent() < index;
  if (!has_parent) {
    return Invalid(field, ".parent: expected ",
                   index == 0 ? "-1" : absl::StrCat("0 to ", index - 1), ", got ", joint.parent());
  }
  if (joint.joint() >= static_cast<uint32_t>(joint_count)) {
    return Invalid(field, ".joint: expected 0 to ", joint_count - 1, ", got ", joint.joint());
  }
  const v1::Point& offset = joint.offset();
  if (!std::isfinite(offset.x()) || !std::isfinite(offset.y()) || !std::isfinite(offset.z())) {
    return Invalid(field, ".offset: expected finite values, got others");
  }
  return absl::OkStatus();
}

constexpr char kRig[] = "frames.rig";

void KeepSign(const motion::UnitQuaternion& before, motion::UnitQuaternion* q) {
  if (before.x * q->x + before.y * q->y + before.z * q->z + before.w * q->w < 0) {
    *q = {-q->x, -q->y, -q->z, -q->w};
  }
}

}  // namespace

absl::StatusOr<std::vector<motion::RestJoint>> ReadRig(
    const std::string& field, const google::protobuf::RepeatedPtrField<v1::RigJoint>& rig,
    int joint_count) {
  std::vector<motion::RestJoint> joints;
  std::set<std::string> names;
  for (const v1::RigJoint& joint : rig) {
    const int index = static_cast<int>(joints.size());
    const std::string indexed = absl::StrCat(field, "[", index, "]");
    absl::Status status = CheckJoint(indexed, joint, index, joint_count);
    if (!status.ok()) return status;
    if (!names.insert(joint.name()).second) {
      return Invalid(indexed, ".name: expected a name once, got ", base::Quoted(joint.name()),
                     " again");
    }
    joints.push_back({joint.name(),
                      joint.parent(),
                      {joint.offset().x(), joint.offset().y(), joint.offset().z()},
                      static_cast<int>(joint.joint())});
  }
  return joints;
}

absl::Status CheckRotations(const std::string& field,
                            const google::protobuf::RepeatedField<float>& values,
                            std::size_t frames, std::size_t rig_joints) {
  const std::size_t wanted = frames * rig_joints * 4;
  if (static_cast<std::size_t>(values.size()) != wanted) {
    return Invalid(field, ": expected ", wanted, " values for ", frames, " frames, got ",
                   values.size());
  }
  for (int i = 0; i < values.size(); i += 4) {
    float squares = 0;
    for (int k = i; k < i + 4; ++k) squares += values[k] * values[k];
    // Negated, so that NaN is rejected.
    if (!(std::abs(std::sqrt(squares) - 1) <= kNormTolerance)) {
      return Invalid(field, "[", i, "..", i + 3, "]: expected a unit quaternion, got norm ",
                     std::sqrt(squares));
    }
  }
  return absl::OkStatus();
}

void AppendRotations(const google::protobuf::RepeatedField<float>& values,
                     std::vector<motion::UnitQuaternion>* rotations) {
  const float* value = values.data();
  for (int i = 0; i < values.size(); i += 4, value += 4) {
    rotations->push_back({value[0], value[1], value[2], value[3]});
  }
}

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
