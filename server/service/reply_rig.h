#ifndef DUET_SERVER_SERVICE_REPLY_RIG_H_
#define DUET_SERVER_SERVICE_REPLY_RIG_H_

#include <optional>
#include <vector>

#include "duet/v1/synthesis.pb.h"
#include "model/motion/clip.h"
#include "model/motion/coordinates.h"
#include "model/motion/levelling.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/rig.h"
#include "model/retargeting/rig_fitting.h"
#include "server/service/rig_format.h"

namespace duet::server::service {

// What the rig of a reply is made from before the follower exists.
struct RigSource {
  motion::Skeleton skeleton;
  // Frames of the leader, spread over its motion: the rest pose has their proportions.
  motion::Clip person;
  double ankle_height_on_floor = 0;  // metres
};

// Requires a leader with at least one frame. leader: [frames, skeleton joints], metres, y up.
RigSource MakeRigSource(const motion::Skeleton& skeleton, const motion::Poses& leader,
                        double frame_rate_hz);

// A rig with the proportions of the source's person and the bone lengths of the follower's first
// frame. Requires a follower with at least one frame.
retargeting::Rig MakeReplyRig(const RigSource& source, const motion::Poses& follower);

// The joint rotations of one reply, frame by frame, in the caller's unit, up axis and tilt. The rig
// has the leader's proportions and the bone lengths of the follower's first frame.
class ReplyRig {
 public:
  // joints: for each joint of the reply, its index in the model; all of the model's, in any order.
  // Requires a unit that is the same in all directions, and a follower with at least one frame.
  // `levelling`: from the caller's world to the follower's.
  ReplyRig(const RigSource& source, const motion::Coordinates& coordinates,
           const std::optional<motion::Levelling>& levelling, const std::vector<int>& joints,
           const motion::Poses& follower);
  ReplyRig(const ReplyRig&) = delete;
  ReplyRig& operator=(const ReplyRig&) = delete;

  void FillHeader(v1::SynthesisHeader& header) const;
  // Adds the rotations of the next frames, and moves the joints of `poses` to where forward
  // kinematics puts them: resampled bones change their lengths a little, the rig's do not.
  void AddRotations(motion::Poses* poses, v1::MotionChunk& chunk);

 private:
  const RigFormat format_;
  const retargeting::Rig rig_;
  retargeting::RigFitter fitter_;
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_REPLY_RIG_H_
