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
#include "model/retargeting/character_rig.h"
#include "model/retargeting/rig_transfer.h"

namespace duet::formats::bvh {
namespace {

using retargeting::CharacterPose;
using retargeting::Quaternion;
using retargeting::Vec3d;

constexpr double kNoTurn = 1e-4;  // radians

using base::Index;

// The root of a person, or of the last one if there are fewer.
int FirstJointOf(const BvhDocument& document, int person) {
  int root = -1, first = 0;
  for (std::size_t j = 0; j < document.joints.size(); ++j) {
    if (document.joints[j].parent < 0 && ++root <= person) first = static_cast<int>(j);
  }
  return first;
}

// One person's joints, without the motion.
BvhDocument PersonOf(const BvhDocument& document, int person) {
  BvhDocument alone;
  const int first = FirstJointOf(document, person);
  for (std::size_t j = Index(first); j < document.joints.size(); ++j) {
    BvhJoint joint = document.joints[j];
    if (joint.parent < 0 && !alone.joints.empty()) break;
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

// A person's rig, and what its file needs to be written again.
struct Rig {
  BvhDocument person;
  retargeting::CharacterFit fit;
  retargeting::CharacterRig rig;
  std::vector<Quaternion> axes;  // [joints], of the joints at rest, in the file's axes
};

// The rest pose is that of the offsets, or of a frame if the offsets make no standing person.
absl::StatusOr<Rig> ReadRig(const BvhDocument& document, absl::string_view source,
                            const BvhImportOptions& options) {
  Rig rig;
  BvhImportOptions reading = options;
  reading.fit = &rig.fit;
  const absl::StatusOr<motion::Clip> read = FromBvh(document, source, reading);
  if (!read.ok()) return read.status();
  rig.person = PersonOf(document, options.person);
  const std::size_t count = rig.person.joints.size();
  const retargeting::JointTree tree = TreeOf(rig.person);
  rig.rig = RestRig(tree, rig.fit);
  rig.axes.resize(count);
  const absl::StatusOr<std::optional<int>> frame =
      retargeting::FindRestFrame(rig.rig, *read, source);
  if (!frame.ok()) return frame.status();
  if (!frame->has_value()) return rig;
  NoteRestFrame(**frame, options);
  BvhKinematics::Pose pose = BvhKinematics(document).PoseAt(**frame);
  const auto first = static_cast<std::ptrdiff_t>(FirstJointOf(document, options.person));
  const auto last = first + static_cast<std::ptrdiff_t>(count);
  rig.rig = RestRig(tree, rig.fit, {pose.positions.begin() + first, pose.positions.begin() + last});
  rig.axes.assign(pose.rotations.begin() + first, pose.rotations.begin() + last);
  return rig;
}

class RigWriter {
 public:
  RigWriter(Rig rig, absl::string_view source, std::optional<PositionChannels> positions)
      : document_(std::move(rig.person)),
        source_(source),
        fit_(std::move(rig.fit)),
        rig_(std::move(rig.rig)),
        axes_(std::move(rig.axes)),
        adds_to_offset_(positions == PositionChannels::kAddToOffset),
        to_world_(retargeting::ToWorldAxes(fit_.up_axis)) {
    // Joints below the root may also have position channels.
    for (std::size_t j = 0; j < document_.joints.size(); ++j) {
      rig_.moves[j] = document_.joints[j].channels.size() == 6;
    }
  }

  absl::StatusOr<BvhDocument> Write(const motion::Clip& clip, const BvhKeys& keys) {
    const absl::StatusOr<std::vector<CharacterPose>> poses = TransferToRig(clip, rig_, source_);
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

  void AppendFrame(const CharacterPose& pose, std::vector<BvhTrack>* tracks) const {
    for (std::size_t j = 0; j < document_.joints.size(); ++j) {
      const BvhJoint& joint = document_.joints[j];
      const Quaternion above = joint.parent < 0 ? Quaternion{} : AxesIn(pose, Index(joint.parent));
      const Vec3d parent_at = joint.parent < 0 ? Vec3d{} : pose.positions[Index(joint.parent)];
      Vec3d place = Rotate(Inverse(above), ToFile(pose.positions[j] - parent_at));
      if (joint.parent >= 0 && adds_to_offset_) place = place - joint.offset;
      (*tracks)[j].turns.push_back(Inverse(above) * AxesIn(pose, j));
      (*tracks)[j].places.push_back(place);
    }
  }

  // A joint's axes in the file's.
  Quaternion AxesIn(const CharacterPose& pose, std::size_t joint) const {
    return Inverse(to_world_) * pose.turns[joint] * to_world_ * axes_[joint];
  }

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
  retargeting::CharacterRig rig_;
  std::vector<Quaternion> axes_;  // [joints], at rest
  bool adds_to_offset_;
  Quaternion to_world_;
};

}  // namespace

absl::StatusOr<BvhDocument> OntoBvhRig(const motion::Clip& clip, const BvhDocument& rig,
                                       absl::string_view source, const BvhImportOptions& options,
                                       const BvhKeys& keys) {
  absl::StatusOr<Rig> read = ReadRig(rig, source, options);
  if (!read.ok()) return read.status();
  return RigWriter(*std::move(read), source, FindPositionChannels(rig)).Write(clip, keys);
}

absl::Status CheckBvhRig(const BvhDocument& document, absl::string_view source,
                         const BvhImportOptions& options) {
  return ReadRig(document, source, options).status();
}

}  // namespace duet::formats::bvh
