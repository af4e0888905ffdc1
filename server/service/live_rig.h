#ifndef DUET_SERVER_SERVICE_LIVE_RIG_H_
#define DUET_SERVER_SERVICE_LIVE_RIG_H_

#include <google/protobuf/repeated_field.h>

#include <vector>

#include "duet/v1/motion.pb.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/rig.h"
#include "model/retargeting/rig_fitting.h"
#include "server/service/reply_mapping.h"
#include "server/service/rig_format.h"

namespace duet::server::service {

// The joint rotations of a live session. The rig has the proportions of the leader and the bone
// lengths of the follower in frame 0, so a resumed session has the same rig if its caller sends
// both frames again. Everything is computed from the follower's frames as the caller gets them.
class LiveRig {
 public:
  // leader, follower: frame 0 of both, [1, joints], in the model's joint order, level metres.
  // Requires a reply in a unit that is the same in all directions, with every joint.
  LiveRig(const motion::Skeleton& skeleton, const ReplyMapping& reply, const motion::Poses& leader,
          const motion::Poses& follower);
  LiveRig(const LiveRig&) = delete;
  LiveRig& operator=(const LiveRig&) = delete;

  // Number of the last frames that the rotations of a frame depend on.
  static int HistoryFrames(double frame_rate_hz) {
    return retargeting::EndlessRigFitter::HistoryFrames(frame_rate_hz);
  }

  void AppendRig(google::protobuf::RepeatedPtrField<v1::RigJoint>* joints) const;

  // Gives the bones the rig's lengths, before the frames are rounded for the caller. The rig has
  // those of frame 0 already.
  void KeepBoneLengths(int first_frame, motion::Poses* poses) const;

  // Fits the next frames, as the caller gets them, and appends their rotations: [frames, rig, 4].
  void Fit(int first_frame, const motion::Poses& poses,
           google::protobuf::RepeatedField<float>* rotations);

 private:
  const motion::Skeleton skeleton_;
  const RigFormat format_;
  const std::vector<float> bone_lengths_;
  const retargeting::Rig rig_;
  retargeting::EndlessRigFitter fitter_;
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_LIVE_RIG_H_
