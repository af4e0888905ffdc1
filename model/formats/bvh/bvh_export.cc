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

constexpr double kDegreesPerRadian = 180 / 3.14159265358979323846;

absl::Status CheckJoints(const motion::Clip& clip, const motion::Skeleton& skeleton) {
  if (clip.joint_names == skeleton.joint_names) return CheckClip("clip", clip);
  return absl::InvalidArgumentError(absl::StrCat("clip: joints: came ", clip.joint_count(),
                                                 ", wanted the skeleton's ", skeleton.joint_count(),
                                                 " in its order"));
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

void AppendFrame(const retargeting::RigPose& pose, double units_per_metre,
                 std::vector<retargeting::EulerZxy>* angles, std::vector<float>* values) {
  const retargeting::Vec3d root = pose.root_position * units_per_metre;
  for (double value : {root.x, root.y, root.z}) values->push_back(static_cast<float>(value));
  for (std::size_t j = 0; j < pose.rotations.size(); ++j) {
    retargeting::EulerZxy& angle = (*angles)[j];
    angle = ToEuler(pose.rotations[j], angle);
    for (double value : {angle.z, angle.x, angle.y}) {
      values->push_back(static_cast<float>(value * kDegreesPerRadian));
    }
  }
}

}  // namespace

absl::StatusOr<BvhDocument> ToBvh(const motion::Clip& clip, const motion::Skeleton& skeleton,
                                  double metres_per_unit) {
  if (absl::Status status = CheckJoints(clip, skeleton); !status.ok()) return status;
  const retargeting::Rig rig = retargeting::MakeRig(skeleton, clip);
  std::vector<int> document_joints;
  BvhDocument document = MakeHierarchy(rig, 1 / metres_per_unit, &document_joints);
  document.frame_time_s = 1 / clip.frame_rate_hz;
  document.frame_count = clip.frame_count();
  retargeting::PoseFitter fitter(rig);
  std::vector<retargeting::EulerZxy> angles(rig.joints.size());
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    AppendFrame(fitter.Fit(clip.poses[frame]), 1 / metres_per_unit, &angles, &document.values);
  }
  return document;
}

}  // namespace duet::formats::bvh
