#include "server/service/reply_rig.h"

#include <algorithm>
#include <cstddef>

#include "model/retargeting/foot_pose.h"

namespace duet::server::service {
namespace {

// Enough for mean proportions; more would delay the header of a long clip.
constexpr int kPersonFrames = 256;

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

retargeting::Rig MakeReplyRig(const RigSource& source, const motion::Poses& follower) {
  retargeting::Rig rig = retargeting::MakeRig(source.skeleton, source.person);
  SetBoneLengths(follower[0], &rig);
  return rig;
}

ReplyRig::ReplyRig(const RigSource& source, const motion::Coordinates& coordinates,
                   const std::optional<motion::Levelling>& levelling,
                   const std::vector<int>& joints, const motion::Poses& follower)
    : format_(coordinates, levelling, joints),
      rig_(MakeReplyRig(source, follower)),
      fitter_(source.skeleton, rig_, source.person.frame_rate_hz, source.ankle_height_on_floor,
              retargeting::BoneLengths::kRigs) {}

void ReplyRig::FillHeader(v1::SynthesisHeader& header) const {
  format_.AppendRig(rig_, header.mutable_rig());
}

void ReplyRig::AddRotations(motion::Poses* poses, v1::MotionChunk& chunk) {
  chunk.mutable_rotations()->Reserve(poses->frame_count() * static_cast<int>(rig_.joints.size()) *
                                     4);
  for (int frame = 0; frame < poses->frame_count(); ++frame) {
    const retargeting::RigPose& pose = fitter_.Fit((*poses)[frame]);
    const std::vector<retargeting::Vec3d> positions = JointPositions(rig_, pose);
    for (std::size_t j = 0; j < rig_.joints.size(); ++j) {
      poses->at(frame, rig_.joints[j].joint) = ToFloat(positions[j]);
    }
    format_.AppendRotations(pose, chunk.mutable_rotations());
  }
}

}  // namespace duet::server::service
