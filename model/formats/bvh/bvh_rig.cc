#include "model/formats/bvh/bvh_rig.h"

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/text.h"
#include "model/motion/coordinates.h"
#include "model/retargeting/euler.h"
#include "model/retargeting/rig_transfer.h"

namespace duet::formats::bvh {
namespace {

using retargeting::CharacterPose;
using retargeting::Quaternion;
using retargeting::Vec3d;

constexpr double kDegreesPerRadian = 180 / 3.14159265358979323846;
constexpr double kNoTurn = 1e-4;  // radians

std::size_t Index(int joint) { return static_cast<std::size_t>(joint); }

bool IsRotation(BvhChannel channel) { return channel >= BvhChannel::kXRotation; }

// 0 x, 1 y, 2 z.
int AxisOf(BvhChannel channel) {
  const BvhChannel first = IsRotation(channel) ? BvhChannel::kXRotation : BvhChannel::kXPosition;
  return static_cast<int>(channel) - static_cast<int>(first);
}

double Component(Vec3d a, int axis) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; }

// From the file's axes to the world's.
Quaternion ToWorldAxes(motion::UpAxis up_axis) {
  const motion::Coordinates file{motion::LengthUnit::kMetres, up_axis};
  const auto in_world = [&file](motion::Vec3 axis) {
    return retargeting::ToDouble(ToWorld(file, axis));
  };
  return retargeting::FromAxes(in_world({1, 0, 0}), in_world({0, 1, 0}), in_world({0, 0, 1}));
}

// One person's joints, without the motion.
BvhDocument PersonOf(const BvhDocument& document, int person) {
  BvhDocument alone;
  int root = -1, first = 0;
  for (std::size_t j = 0; j < document.joints.size(); ++j) {
    BvhJoint joint = document.joints[j];
    if (joint.parent < 0 && ++root <= person) {
      alone.joints.clear();
      first = static_cast<int>(j);
    }
    if (root > person) break;
    if (joint.parent >= 0) joint.parent -= first;
    alone.joints.push_back(std::move(joint));
  }
  return alone;
}

class RigWriter {
 public:
  RigWriter(BvhDocument rig, absl::string_view source, const retargeting::CharacterFit& fit,
            std::optional<PositionChannels> positions)
      : document_(std::move(rig)),
        source_(source),
        fit_(fit),
        adds_to_offset_(positions == PositionChannels::kAddToOffset),
        to_world_(ToWorldAxes(fit.up_axis)) {
    for (const BvhJoint& joint : document_.joints) {
      std::vector<int> axes;
      for (BvhChannel channel : joint.channels) {
        if (IsRotation(channel)) axes.push_back(AxisOf(channel));
      }
      const bool any_turn =
          axes.size() == 3 && axes[0] != axes[1] && axes[1] != axes[2] && axes[0] != axes[2];
      orders_.push_back(any_turn ? std::optional<retargeting::EulerOrder>(
                                       retargeting::EulerOrder{axes[0], axes[1], axes[2]})
                                 : std::nullopt);
      angles_.push_back({});
    }
  }

  absl::StatusOr<BvhDocument> Write(const motion::Clip& clip) {
    const retargeting::CharacterRig rig = Rig();
    const absl::StatusOr<std::vector<CharacterPose>> poses = TransferToRig(clip, rig, source_);
    if (!poses.ok()) return poses.status();
    document_.frame_time_s = 1 / clip.frame_rate_hz;
    document_.frame_count = clip.frame_count();
    for (const CharacterPose& pose : *poses) {
      absl::Status status = AppendFrame(pose);
      if (!status.ok()) return status;
    }
    return std::move(document_);
  }

 private:
  Vec3d ToWorld(Vec3d in_file) const { return Rotate(to_world_, in_file) * fit_.metres_per_unit; }
  Vec3d ToFile(Vec3d in_world) const {
    return Rotate(Inverse(to_world_), in_world) * (1 / fit_.metres_per_unit);
  }

  // At rest no joint of a BVH is turned.
  retargeting::CharacterRig Rig() const {
    retargeting::CharacterRig rig;
    rig.joints = fit_.joints;
    for (const BvhJoint& joint : document_.joints) {
      rig.names.push_back(joint.name);
      rig.parents.push_back(joint.parent);
      rig.positions.push_back(
          joint.parent < 0 ? Vec3d{} : rig.positions[Index(joint.parent)] + ToWorld(joint.offset));
      rig.moves.push_back(joint.channels.size() == 6);
    }
    return rig;
  }

  absl::Status AppendFrame(const CharacterPose& pose) {
    for (std::size_t j = 0; j < document_.joints.size(); ++j) {
      const BvhJoint& joint = document_.joints[j];
      const Quaternion above =
          joint.parent < 0 ? Quaternion{} : InFile(pose.turns[Index(joint.parent)]);
      const Quaternion turn = Inverse(above) * InFile(pose.turns[j]);
      const Vec3d parent_at = joint.parent < 0 ? Vec3d{} : pose.positions[Index(joint.parent)];
      Vec3d place = Rotate(Inverse(above), ToFile(pose.positions[j] - parent_at));
      if (joint.parent >= 0 && adds_to_offset_) place = place - joint.offset;
      absl::Status status = AppendJoint(j, turn, place);
      if (!status.ok()) return status;
    }
    return absl::OkStatus();
  }

  // A turn of the world in the file's axes.
  Quaternion InFile(Quaternion turn) const { return Inverse(to_world_) * turn * to_world_; }

  absl::Status AppendJoint(std::size_t j, Quaternion turn, Vec3d place) {
    const BvhJoint& joint = document_.joints[j];
    if (orders_[j].has_value()) {
      angles_[j] = ToEuler(turn, *orders_[j], angles_[j]);
    } else if (!joint.end_site && Angle(turn, {}) > kNoTurn) {
      return absl::InvalidArgumentError(
          absl::StrCat(source_, ": rig: ", base::Quoted(joint.name),
                       " has to turn, and has not three rotation channels about three axes"));
    }
    std::size_t rotation = 0;
    for (BvhChannel channel : joint.channels) {
      const double value = !IsRotation(channel)     ? Component(place, AxisOf(channel))
                           : orders_[j].has_value() ? angles_[j][rotation++] * kDegreesPerRadian
                                                    : 0;
      document_.values.push_back(static_cast<float>(value));
    }
    return absl::OkStatus();
  }

  BvhDocument document_;
  std::string source_;
  retargeting::CharacterFit fit_;
  bool adds_to_offset_;
  Quaternion to_world_;
  std::vector<std::optional<retargeting::EulerOrder>> orders_;  // [joints], where a joint turns
  std::vector<retargeting::EulerAngles> angles_;                // [joints], of the last frame
};

}  // namespace

absl::StatusOr<BvhDocument> OntoBvhRig(const motion::Clip& clip, const BvhDocument& rig,
                                       absl::string_view source, const BvhImportOptions& options) {
  retargeting::CharacterFit fit;
  BvhImportOptions reading = options;
  reading.fit = &fit;
  reading.notes = nullptr;
  reading.report = nullptr;
  const absl::StatusOr<motion::Clip> read = FromBvh(rig, source, reading);
  if (!read.ok()) return read.status();
  return RigWriter(PersonOf(rig, options.person), source, fit, FindPositionChannels(rig))
      .Write(clip);
}

}  // namespace duet::formats::bvh
