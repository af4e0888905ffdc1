#include "model/formats/bvh/bvh_motion.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/angle.h"
#include "model/base/index.h"
#include "model/base/text.h"
#include "model/motion/coordinates.h"
#include "model/retargeting/character.h"
#include "model/retargeting/rig_fitting.h"
#include "model/retargeting/rotation.h"

namespace duet::formats::bvh {
namespace {

using base::Index;
using retargeting::CharacterPose;
using retargeting::EulerAngles;
using retargeting::EulerOrder;
using retargeting::Quaternion;
using retargeting::Vec3d;

constexpr double kNoTurn = 1e-4;  // radians

// The order of a joint's rotation channels; absent unless it has one about each of three axes.
std::optional<EulerOrder> RotationOrder(const BvhJoint& joint) {
  std::vector<int> axes;
  for (BvhChannel channel : joint.channels) {
    if (IsRotation(channel)) axes.push_back(AxisOf(channel));
  }
  if (axes.size() != 3 || axes[0] == axes[1] || axes[1] == axes[2] || axes[0] == axes[2]) {
    return std::nullopt;
  }
  return EulerOrder{axes[0], axes[1], axes[2]};
}

}  // namespace

void WriteMotion(const std::vector<BvhTrack>& tracks, double frame_rate_hz, BvhDocument* document) {
  std::vector<std::vector<EulerAngles>> angles(tracks.size());
  std::size_t frames = 0;
  for (std::size_t j = 0; j < tracks.size(); ++j) {
    frames = std::max(frames, tracks[j].places.size());
    const std::optional<EulerOrder> order = RotationOrder(document->joints[j]);
    if (order.has_value()) angles[j] = ToEulerTrack(tracks[j].turns, *order);
  }
  document->frame_time_s = 1 / frame_rate_hz;
  document->frame_count = static_cast<int>(frames);
  document->values.clear();
  for (std::size_t frame = 0; frame < frames; ++frame) {
    for (std::size_t j = 0; j < tracks.size(); ++j) {
      std::size_t turn = 0;
      for (BvhChannel channel : document->joints[j].channels) {
        const bool turns = IsRotation(channel) && !angles[j].empty();
        const double value = turns ? angles[j][frame][turn++] * base::kDegreesPerRadian
                             : IsRotation(channel)
                                 ? 0
                                 : Component(tracks[j].places[frame], AxisOf(channel));
        document->values.push_back(static_cast<float>(value));
      }
    }
  }
}

namespace {

// The joints of a person, which are contiguous.
struct Range {
  std::size_t begin = 0, end = 0;
};

// The joints of the first person if there are fewer.
Range JointsOfPerson(const BvhDocument& document, int person) {
  std::vector<std::size_t> roots;
  for (std::size_t j = 0; j < document.joints.size(); ++j) {
    if (document.joints[j].parent < 0) roots.push_back(j);
  }
  roots.push_back(document.joints.size());
  const std::size_t p = Index(person) + 1 < roots.size() ? Index(person) : 0;
  return {roots[p], roots[p + 1]};
}

// One person's joints, without the motion.
BvhDocument PersonOf(const BvhDocument& document, Range range) {
  BvhDocument person;
  for (std::size_t j = range.begin; j < range.end; ++j) {
    person.joints.push_back(document.joints[j]);
    int& parent = person.joints.back().parent;
    if (parent >= 0) parent -= static_cast<int>(range.begin);
  }
  return person;
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

double FrameRate(const BvhDocument& document) {
  return RateOfFrameTime(document.frame_time_s, document.frame_time_decimals);
}

void Report(const BvhDocument& document, double frame_rate_hz, retargeting::ReadingReport* report) {
  if (report == nullptr) return;
  report->people =
      static_cast<int>(std::count_if(document.joints.begin(), document.joints.end(),
                                     [](const BvhJoint& joint) { return joint.parent < 0; }));
  report->frame_rate =
      retargeting::Setting{absl::StrCat(frame_rate_hz, " Hz"), retargeting::Origin::kFile,
                           absl::StrCat("Frame Time ", document.frame_time_s)};
  if (!document.stated_frame_count.has_value()) return;
  report->remarks.push_back(absl::StrCat("frames: the file has ", document.frame_count,
                                         ", and states ", *document.stated_frame_count));
}

}  // namespace

absl::StatusOr<motion::Clip> FromBvh(const BvhDocument& document, absl::string_view source,
                                     const BvhImportOptions& options) {
  const Range joints = JointsOfPerson(document, options.person);
  Report(document, FrameRate(document), options.report);
  retargeting::Character character;
  character.tree = TreeOf(PersonOf(document, joints));
  character.frame_count = document.frame_count;
  character.frame_rate_hz = FrameRate(document);
  character.pose = [&](int frame) {
    const std::vector<Vec3d> all = PoseAt(document, frame).positions;
    std::vector<motion::Vec3> pose;
    pose.reserve(joints.end - joints.begin);
    for (std::size_t j = joints.begin; j < joints.end; ++j) pose.push_back(ToFloat(all[j]));
    return pose;
  };
  return ToClip(character, source, options);
}

namespace {

// End Sites follow their joints.
BvhDocument MakeHierarchy(const retargeting::Rig& rig, double units_per_metre) {
  const std::vector<BvhChannel> turns = {BvhChannel::kZRotation, BvhChannel::kXRotation,
                                         BvhChannel::kYRotation};
  BvhDocument document;
  std::vector<int> places;  // [rig joints], in the document
  for (const retargeting::RigJoint& joint : rig.joints) {
    BvhJoint written;
    written.name = joint.name;
    if (joint.parent < 0) {
      written.channels = {BvhChannel::kXPosition, BvhChannel::kYPosition, BvhChannel::kZPosition};
    } else {
      written.parent = places[Index(joint.parent)];
    }
    written.offset = joint.offset * units_per_metre;
    written.channels.insert(written.channels.end(), turns.begin(), turns.end());
    places.push_back(static_cast<int>(document.joints.size()));
    document.joints.push_back(std::move(written));
    if (joint.kind != retargeting::RigJoint::Kind::kLeaf) continue;
    document.joints.push_back({joint.name + ".end",
                               places.back(),
                               joint.end_offset * units_per_metre,
                               {},
                               /*end_site=*/true});
  }
  return document;
}

}  // namespace

BvhDocument ToBvh(const motion::Clip& clip, const motion::Skeleton& skeleton,
                  double metres_per_unit) {
  const retargeting::Rig rig = retargeting::MakeRig(skeleton, clip);
  BvhDocument document = MakeHierarchy(rig, 1 / metres_per_unit);
  std::vector<BvhTrack> tracks(document.joints.size());
  retargeting::PoseFitter fitter(rig, clip.frame_rate_hz);
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    const retargeting::RigPose& pose = fitter.Fit(clip.poses[frame]);
    tracks[0].places.push_back(pose.root_position * (1 / metres_per_unit));
    std::size_t joint = 0;
    for (std::size_t j = 0; j < tracks.size(); ++j) {
      if (!document.joints[j].end_site) tracks[j].turns.push_back(pose.rotations[joint++]);
    }
  }
  WriteMotion(tracks, clip.frame_rate_hz, &document);
  return document;
}

namespace {

// A person's rig, and what its file needs to be written again.
class RigFile {
 public:
  explicit RigFile(absl::string_view source) : source_(source) {}

  // The rest pose is that of the offsets, or of a frame if the offsets make no standing person.
  absl::Status Read(const BvhDocument& document, const BvhImportOptions& options) {
    BvhImportOptions reading = options;
    reading.fit = &fit_;
    const absl::StatusOr<motion::Clip> read = FromBvh(document, source_, reading);
    if (!read.ok()) return read.status();
    const Range joints = JointsOfPerson(document, options.person);
    document_ = PersonOf(document, joints);
    const retargeting::JointTree tree = TreeOf(document_);
    rig_ = RestRig(tree, fit_);
    axes_.resize(document_.joints.size());
    to_world_ = retargeting::ToWorldAxes(fit_.up_axis);
    const absl::StatusOr<std::optional<int>> frame =
        retargeting::FindRestFrame(rig_, *read, source_);
    if (!frame.ok()) return frame.status();
    if (frame->has_value()) {
      if (options.report != nullptr) {
        options.report->remarks.push_back(
            absl::StrCat("rest pose: that of frame ", **frame,
                         ", because the bones of the rig at rest make no standing person"));
      }
      const BvhPose pose = PoseAt(document, **frame);
      const auto first = static_cast<std::ptrdiff_t>(joints.begin);
      const auto last = static_cast<std::ptrdiff_t>(joints.end);
      rig_ = RestRig(tree, fit_, {pose.positions.begin() + first, pose.positions.begin() + last});
      axes_.assign(pose.rotations.begin() + first, pose.rotations.begin() + last);
    }
    // Joints below the root may also have position channels.
    for (std::size_t j = 0; j < document_.joints.size(); ++j) {
      rig_.moves[j] = document_.joints[j].channels.size() == 6;
    }
    return absl::OkStatus();
  }

  absl::StatusOr<BvhDocument> Write(const motion::Clip& clip) {
    const absl::StatusOr<std::vector<CharacterPose>> poses = TransferToRig(clip, rig_, source_);
    if (!poses.ok()) return poses.status();
    std::vector<BvhTrack> tracks(document_.joints.size());
    for (const CharacterPose& pose : *poses) AppendFrame(pose, &tracks);
    for (std::size_t j = 0; j < tracks.size(); ++j) {
      absl::Status status = CheckTurns(document_.joints[j], tracks[j]);
      if (!status.ok()) return status;
    }
    WriteMotion(tracks, clip.frame_rate_hz, &document_);
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
      const Vec3d place = Rotate(Inverse(above), ToFile(pose.positions[j] - parent_at));
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

  const std::string source_;
  BvhDocument document_;  // of the person
  retargeting::CharacterFit fit_;
  retargeting::CharacterRig rig_;
  std::vector<Quaternion> axes_;  // [joints], of the joints at rest, in the file's axes
  Quaternion to_world_;
};

}  // namespace

absl::StatusOr<BvhDocument> OntoBvhRig(const motion::Clip& clip, const BvhDocument& rig,
                                       absl::string_view source, const BvhImportOptions& options) {
  RigFile file(source);
  absl::Status status = file.Read(rig, options);
  if (!status.ok()) return status;
  return file.Write(clip);
}

}  // namespace duet::formats::bvh
