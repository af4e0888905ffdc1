#include "server/service/reply_mapping.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "model/motion/limb_lengths.h"
#include "model/retargeting/character.h"
#include "model/retargeting/foot_pose.h"

namespace duet::server::service {

void AppendPositions(const ReplyMapping& reply, const motion::Poses& poses,
                     google::protobuf::RepeatedField<float>* positions) {
  positions->Reserve(positions->size() +
                     poses.frame_count() * static_cast<int>(reply.joints.size()) * 3);
  for (int frame = 0; frame < poses.frame_count(); ++frame) {
    for (const int joint : reply.joints) {
      const motion::Vec3 level = poses.at(frame, joint);
      const motion::Vec3 world = reply.levelling ? reply.levelling->Invert(level) : level;
      const motion::Vec3 position = FromWorld(reply.coordinates, world);
      positions->Add(position.x);
      positions->Add(position.y);
      positions->Add(position.z);
    }
  }
}

motion::Poses FromPositions(const ReplyMapping& reply,
                            const google::protobuf::RepeatedField<float>& positions) {
  const int joints = static_cast<int>(reply.joints.size());
  motion::Poses poses(positions.size() / 3 / joints, joints);
  const float* xyz = positions.data();
  for (int frame = 0; frame < poses.frame_count(); ++frame) {
    for (const int joint : reply.joints) {
      const motion::Vec3 world = ToWorld(reply.coordinates, {xyz[0], xyz[1], xyz[2]});
      poses.at(frame, joint) = reply.levelling ? reply.levelling->Apply(world) : world;
      xyz += 3;
    }
  }
  return poses;
}

namespace {

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

// Enough for mean proportions; more would delay the header of a long clip.
constexpr int kPersonFrames = 256;

// Chooses the sign in which w is not negative, because a resumed session does not know the signs of
// earlier frames.
void ChooseSigns(google::protobuf::RepeatedField<float>* rotations, int begin) {
  for (int i = begin; i < rotations->size(); i += 4) {
    float* const q = rotations->mutable_data() + i;
    if (q[3] < 0) std::transform(q, q + 4, q, [](float value) { return -value; });
  }
}

}  // namespace

RigFormat::RigFormat(const ReplyMapping& reply)
    : coordinates_(reply.coordinates),
      to_caller_(retargeting::Inverse(retargeting::ToWorldAxes(reply.coordinates.up_axis))),
      tilt_(TiltOf(reply.levelling)),
      reply_joints_(Inverse(reply.joints)) {}

void RigFormat::AppendRig(const retargeting::Rig& rig,
                          google::protobuf::RepeatedPtrField<v1::RigJoint>* joints) const {
  for (const retargeting::RigJoint& joint : rig.joints) {
    v1::RigJoint& added = *joints->Add();
    added.set_name(joint.name);
    added.set_parent(joint.parent);
    added.set_joint(static_cast<uint32_t>(reply_joints_[static_cast<std::size_t>(joint.joint)]));
    const motion::Vec3 offset = FromWorld(coordinates_, ToFloat(joint.offset));
    added.mutable_offset()->set_x(offset.x);
    added.mutable_offset()->set_y(offset.y);
    added.mutable_offset()->set_z(offset.z);
  }
}

void RigFormat::AppendRotations(const retargeting::RigPose& pose,
                                google::protobuf::RepeatedField<float>* rotations) const {
  for (std::size_t j = 0; j < pose.rotations.size(); ++j) {
    const retargeting::Quaternion q = j == 0 ? tilt_ * pose.rotations[j] : pose.rotations[j];
    const retargeting::Vec3d axis = Rotate(to_caller_, {q.x, q.y, q.z});
    for (const double value : {axis.x, axis.y, axis.z, q.w}) {
      rotations->Add(static_cast<float>(value));
    }
  }
}

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

namespace {

// A rig with the proportions of the source's person and the bone lengths of the follower's first
// frame.
retargeting::Rig MakeReplyRig(const RigSource& source, const motion::Poses& follower) {
  retargeting::Rig rig = retargeting::MakeRig(source.skeleton, source.person);
  SetBoneLengths(follower[0], &rig);
  return rig;
}

}  // namespace

ReplyRig::ReplyRig(const ReplyMapping& reply, const motion::Poses& follower)
    : format_(reply),
      rig_(MakeReplyRig(*reply.rig, follower)),
      fitter_(reply.rig->skeleton, rig_, reply.rig->person.frame_rate_hz,
              reply.rig->ankle_height_on_floor, retargeting::BoneLengths::kRigs) {}

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

LiveRig::LiveRig(const motion::Skeleton& skeleton, const ReplyMapping& reply,
                 const motion::Poses& leader, const motion::Poses& follower)
    : skeleton_(skeleton),
      format_(reply),
      bone_lengths_(MedianBoneLengths(skeleton, follower)),
      rig_(MakeReplyRig(MakeRigSource(skeleton, leader, reply.frame_rate_hz), follower)),
      fitter_(skeleton, rig_, reply.frame_rate_hz,
              MakeRigSource(skeleton, leader, reply.frame_rate_hz).ankle_height_on_floor) {}

void LiveRig::AppendRig(google::protobuf::RepeatedPtrField<v1::RigJoint>* joints) const {
  format_.AppendRig(rig_, joints);
}

void LiveRig::KeepBoneLengths(int first_frame, motion::Poses* poses) const {
  const int first = first_frame == 0 ? 1 : 0;
  motion::Poses kept(0, poses->joint_count());
  kept.Append(poses->frames(first, poses->frame_count() - first));
  SetBoneLengths(skeleton_, bone_lengths_, &kept);
  poses->Resize(first);
  poses->Append(kept.all());
}

void LiveRig::Fit(int first_frame, const motion::Poses& poses,
                  google::protobuf::RepeatedField<float>* rotations) {
  const int begin = rotations->size();
  for (int t = 0; t < poses.frame_count(); ++t) {
    format_.AppendRotations(fitter_.Fit(first_frame + t, poses[t]), rotations);
  }
  ChooseSigns(rotations, begin);
}

}  // namespace duet::server::service
