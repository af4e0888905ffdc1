#include "model/formats/bvh/bvh_rig.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/index.h"
#include "model/base/text.h"
#include "model/motion/coordinates.h"
#include "model/retargeting/rest_rig.h"
#include "model/retargeting/rig_transfer.h"

namespace duet::formats::bvh {
namespace {

using retargeting::CharacterPose;
using retargeting::Quaternion;
using retargeting::Vec3d;

constexpr double kNoTurn = 1e-4;  // radians

using base::Index;

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

retargeting::JointTree TreeOf(const BvhDocument& person) {
  retargeting::JointTree tree;
  for (const BvhJoint& joint : person.joints) {
    tree.names.push_back(joint.name);
    tree.parents.push_back(joint.parent);
    tree.offsets.push_back(joint.offset);
  }
  return tree;
}

absl::StatusOr<retargeting::CharacterFit> FitOf(const BvhDocument& document,
                                                absl::string_view source,
                                                const BvhImportOptions& options) {
  retargeting::CharacterFit fit;
  BvhImportOptions reading = options;
  reading.fit = &fit;
  const absl::StatusOr<motion::Clip> read = FromBvh(document, source, reading);
  if (!read.ok()) return read.status();
  return fit;
}

class RigWriter {
 public:
  RigWriter(BvhDocument rig, absl::string_view source, const retargeting::CharacterFit& fit,
            std::optional<PositionChannels> positions)
      : document_(std::move(rig)),
        source_(source),
        fit_(fit),
        adds_to_offset_(positions == PositionChannels::kAddToOffset),
        to_world_(retargeting::ToWorldAxes(fit.up_axis)) {}

  absl::StatusOr<BvhDocument> Write(const motion::Clip& clip, const BvhKeys& keys) {
    const absl::StatusOr<std::vector<CharacterPose>> poses = TransferToRig(clip, Rig(), source_);
    if (!poses.ok()) return poses.status();
    std::vector<BvhTrack> tracks(document_.joints.size());
    for (const CharacterPose& pose : *poses) AppendFrame(pose, &tracks);
    for (std::size_t j = 0; j < tracks.size(); ++j) {
      absl::Status status = CheckTurns(document_.joints[j], tracks[j]);
      if (!status.ok()) return status;
    }
    WriteMotion(tracks, clip.frame_rate_hz, keys, &document_);
    return std::move(document_);
  }

 private:
  Vec3d ToFile(Vec3d in_world) const {
    return Rotate(Inverse(to_world_), in_world) * (1 / fit_.metres_per_unit);
  }

  // Joints below the root may also have position channels.
  retargeting::CharacterRig Rig() const {
    retargeting::CharacterRig rig = RestRig(TreeOf(document_), fit_);
    for (std::size_t j = 0; j < document_.joints.size(); ++j) {
      rig.moves[j] = document_.joints[j].channels.size() == 6;
    }
    return rig;
  }

  void AppendFrame(const CharacterPose& pose, std::vector<BvhTrack>* tracks) const {
    for (std::size_t j = 0; j < document_.joints.size(); ++j) {
      const BvhJoint& joint = document_.joints[j];
      const Quaternion above =
          joint.parent < 0 ? Quaternion{} : InFile(pose.turns[Index(joint.parent)]);
      const Vec3d parent_at = joint.parent < 0 ? Vec3d{} : pose.positions[Index(joint.parent)];
      Vec3d place = Rotate(Inverse(above), ToFile(pose.positions[j] - parent_at));
      if (joint.parent >= 0 && adds_to_offset_) place = place - joint.offset;
      (*tracks)[j].turns.push_back(Inverse(above) * InFile(pose.turns[j]));
      (*tracks)[j].places.push_back(place);
    }
  }

  // Converts a rotation in world axes to the file's axes.
  Quaternion InFile(Quaternion turn) const { return Inverse(to_world_) * turn * to_world_; }

  absl::Status CheckTurns(const BvhJoint& joint, const BvhTrack& track) const {
    const auto turns = [](Quaternion turn) { return Angle(turn, {}) > kNoTurn; };
    if (joint.end_site || RotationOrder(joint).has_value() ||
        std::none_of(track.turns.begin(), track.turns.end(), turns)) {
      return absl::OkStatus();
    }
    return absl::InvalidArgumentError(
        absl::StrCat(source_, ": rig: ", base::Quoted(joint.name),
                     ": expected rotation channels about three axes, got fewer; the motion turns "
                     "this joint"));
  }

  BvhDocument document_;
  std::string source_;
  retargeting::CharacterFit fit_;
  bool adds_to_offset_;
  Quaternion to_world_;
};

}  // namespace

absl::StatusOr<BvhDocument> OntoBvhRig(const motion::Clip& clip, const BvhDocument& rig,
                                       absl::string_view source, const BvhImportOptions& options,
                                       const BvhKeys& keys) {
  const absl::StatusOr<retargeting::CharacterFit> fit = FitOf(rig, source, options);
  if (!fit.ok()) return fit.status();
  return RigWriter(PersonOf(rig, options.person), source, *fit, FindPositionChannels(rig))
      .Write(clip, keys);
}

absl::StatusOr<retargeting::CharacterRig> BvhRig(const BvhDocument& document,
                                                 absl::string_view source,
                                                 const BvhImportOptions& options) {
  const absl::StatusOr<retargeting::CharacterFit> fit = FitOf(document, source, options);
  if (!fit.ok()) return fit.status();
  return RestRig(TreeOf(PersonOf(document, options.person)), *fit);
}

}  // namespace duet::formats::bvh
