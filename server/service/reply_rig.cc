#include "server/service/reply_rig.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "model/retargeting/foot_pose.h"
#include "model/retargeting/rest_rig.h"

namespace duet::server::service {
namespace {

// Enough for mean proportions; more would delay the header of a long clip.
constexpr int kPersonFrames = 256;

retargeting::Rig RigOf(const RigSource& source, const motion::Poses& follower) {
  retargeting::Rig rig = retargeting::MakeRig(source.skeleton, source.person);
  SetBoneLengths(follower[0], &rig);
  return rig;
}

// The rotation that Levelling::Invert applies.
retargeting::Quaternion TiltOf(const std::optional<motion::Levelling>& levelling) {
  if (!levelling) return {};
  const motion::Vec3 up = levelling->up();
  return retargeting::ShortestArc({0, 1, 0}, {up.x, up.y, up.z}, {1, 0, 0});
}

std::vector<int> Inverse(const std::vector<int>& joints) {
  std::vector<int> inverse(joints.size());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    inverse[static_cast<std::size_t>(joints[i])] = static_cast<int>(i);
  }
  return inverse;
}

}  // namespace

RigSource MakeRigSource(const motion::Skeleton& skeleton, const motion::Poses& leader,
                        double frame_rate_hz) {
  RigSource source;
  source.skeleton = skeleton;
  source.person.joint_names = skeleton.joint_names;
  source.person.frame_rate_hz = frame_rate_hz;
  const int frames = leader.frame_count();
  const int step = (frames + kPersonFrames - 1) / kPersonFrames;
  for (int frame = 0; frame < frames; frame += step) source.person.Append(leader[frame]);
  source.ankle_height_on_floor = retargeting::AnkleHeightOnFloor(skeleton, source.person);
  return source;
}

ReplyRig::ReplyRig(const RigSource& source, const motion::Coordinates& coordinates,
                   const std::optional<motion::Levelling>& levelling,
                   const std::vector<int>& joints, const motion::Poses& follower)
    : coordinates_(coordinates),
      to_caller_(retargeting::Inverse(retargeting::ToWorldAxes(coordinates.up_axis))),
      tilt_(TiltOf(levelling)),
      reply_joints_(Inverse(joints)),
      rig_(RigOf(source, follower)),
      fitter_(source.skeleton, rig_, source.person.frame_rate_hz, source.ankle_height_on_floor,
              retargeting::BoneLengths::kRigs) {}

void ReplyRig::FillHeader(v1::SynthesisHeader& header) const {
  for (const retargeting::RigJoint& joint : rig_.joints) {
    v1::RigJoint& added = *header.add_rig();
    added.set_name(joint.name);
    added.set_parent(joint.parent);
    added.set_joint(static_cast<uint32_t>(reply_joints_[static_cast<std::size_t>(joint.joint)]));
    const motion::Vec3 offset = FromWorld(coordinates_, ToFloat(joint.offset));
    added.mutable_offset()->set_x(offset.x);
    added.mutable_offset()->set_y(offset.y);
    added.mutable_offset()->set_z(offset.z);
  }
}

void ReplyRig::AddRotations(motion::Poses* poses, v1::MotionChunk& chunk) {
  chunk.mutable_rotations()->Reserve(poses->frame_count() * static_cast<int>(rig_.joints.size()) *
                                     4);
  for (int frame = 0; frame < poses->frame_count(); ++frame) {
    const retargeting::RigPose& pose = fitter_.Fit((*poses)[frame]);
    const std::vector<retargeting::Vec3d> positions = JointPositions(rig_, pose);
    for (std::size_t j = 0; j < rig_.joints.size(); ++j) {
      poses->at(frame, rig_.joints[j].joint) = ToFloat(positions[j]);
      const retargeting::Quaternion q = j == 0 ? tilt_ * pose.rotations[j] : pose.rotations[j];
      const retargeting::Vec3d axis = Rotate(to_caller_, {q.x, q.y, q.z});
      for (const double value : {axis.x, axis.y, axis.z, q.w}) {
        chunk.add_rotations(static_cast<float>(value));
      }
    }
  }
}

}  // namespace duet::server::service
