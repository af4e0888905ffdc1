#include "server/service/live_rig.h"

#include <algorithm>

#include "model/motion/limb_lengths.h"
#include "model/retargeting/foot_pose.h"
#include "server/service/reply_rig.h"

namespace duet::server::service {
namespace {

// Chooses the sign in which w is not negative, because a resumed session does not know the signs of
// earlier frames.
void ChooseSigns(google::protobuf::RepeatedField<float>* rotations, int begin) {
  for (int i = begin; i < rotations->size(); i += 4) {
    float* const q = rotations->mutable_data() + i;
    if (q[3] < 0) std::transform(q, q + 4, q, [](float value) { return -value; });
  }
}

}  // namespace

LiveRig::LiveRig(const motion::Skeleton& skeleton, const ReplyMapping& reply,
                 const motion::Poses& leader, const motion::Poses& follower)
    : skeleton_(skeleton),
      format_(reply.coordinates, reply.levelling, reply.joints),
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
