#include "model/formats/bvh/bvh_export.h"

#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/motion/recorded_motion.h"
#include "model/retargeting/pose_fitting.h"
#include "model/retargeting/rig.h"

namespace duet::formats::bvh {
namespace {

absl::Status CheckJoints(const motion::Clip& clip, const motion::Skeleton& skeleton) {
  if (clip.joint_names == skeleton.joint_names) return CheckClip("clip", clip);
  return absl::InvalidArgumentError(absl::StrCat("clip: joints: expected the skeleton's ",
                                                 skeleton.joint_count(), " in its order, got ",
                                                 clip.joint_count()));
}

BvhDocument MakeHierarchy(const retargeting::Rig& rig, double units_per_metre,
                          std::vector<int>* document_joints) {
  const std::vector<BvhChannel> turns = {BvhChannel::kZRotation, BvhChannel::kXRotation,
                                         BvhChannel::kYRotation};
  BvhDocument document;
  for (const retargeting::RigJoint& joint : rig.joints) {
    BvhJoint written;
    written.name = joint.name;
    if (joint.parent < 0) {
      written.channels = {BvhChannel::kXPosition, BvhChannel::kYPosition, BvhChannel::kZPosition};
    } else {
      written.parent = (*document_joints)[static_cast<size_t>(joint.parent)];
    }
    written.offset = joint.offset * units_per_metre;
    written.channels.insert(written.channels.end(), turns.begin(), turns.end());
    document_joints->push_back(static_cast<int>(document.joints.size()));
    document.joints.push_back(std::move(written));
    if (joint.kind != retargeting::RigJoint::Kind::kLeaf) continue;
    BvhJoint end;
    end.name = joint.name + ".end";
    end.parent = document_joints->back();
    end.offset = joint.end_offset * units_per_metre;
    end.end_site = true;
    document.joints.push_back(std::move(end));
  }
  return document;
}

std::vector<BvhTrack> TracksOf(const retargeting::Rig& rig, const motion::Clip& clip,
                               const std::vector<int>& document_joints, std::size_t joint_count,
                               double units_per_metre) {
  std::vector<BvhTrack> tracks(joint_count);
  retargeting::PoseFitter fitter(rig, clip.frame_rate_hz);
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    const retargeting::RigPose& pose = fitter.Fit(clip.poses[frame]);
    tracks[0].places.push_back(pose.root_position * units_per_metre);
    for (std::size_t j = 0; j < pose.rotations.size(); ++j) {
      tracks[static_cast<std::size_t>(document_joints[j])].turns.push_back(pose.rotations[j]);
    }
  }
  return tracks;
}

}  // namespace

absl::StatusOr<BvhDocument> ToBvh(const motion::Clip& clip, const motion::Skeleton& skeleton,
                                  double metres_per_unit, const BvhKeys& keys) {
  if (absl::Status status = CheckJoints(clip, skeleton); !status.ok()) return status;
  const retargeting::Rig rig = retargeting::MakeRig(skeleton, clip);
  std::vector<int> document_joints;
  BvhDocument document = MakeHierarchy(rig, 1 / metres_per_unit, &document_joints);
  WriteMotion(TracksOf(rig, clip, document_joints, document.joints.size(), 1 / metres_per_unit),
              clip.frame_rate_hz, keys, &document);
  return document;
}

}  // namespace duet::formats::bvh
