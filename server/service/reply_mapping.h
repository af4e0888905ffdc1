#ifndef DUET_SERVER_SERVICE_REPLY_MAPPING_H_
#define DUET_SERVER_SERVICE_REPLY_MAPPING_H_

#include <google/protobuf/repeated_field.h>

#include <optional>
#include <string>
#include <vector>

#include "duet/v1/motion.pb.h"
#include "duet/v1/synthesis.pb.h"
#include "model/motion/clip.h"
#include "model/motion/coordinates.h"
#include "model/motion/levelling.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/rig_fitting.h"
#include "model/retargeting/rotation.h"

namespace duet::server::service {

// What the rig of a reply is made from before the follower exists.
struct RigSource {
  motion::Skeleton skeleton;
  // Frames of the leader, spread over its motion: the rest pose has their proportions.
  motion::Clip person;
  double ankle_height_on_floor = 0;  // metres
};

// Maps the model's follower to the caller's joints, order, unit, up axis and tilt.
struct ReplyMapping {
  motion::Coordinates coordinates;
  // From the caller's world to the level world of the model; absent if the caller's is level.
  std::optional<motion::Levelling> levelling;
  std::vector<int> joints;               // for each joint of the reply, its index in the model
  std::vector<std::string> joint_names;  // of the reply
  // Those of the leader, repeated in the header.
  v1::LengthUnit unit = v1::LENGTH_UNIT_UNSPECIFIED;
  v1::UpAxis up_axis = v1::UP_AXIS_UNSPECIFIED;
  double frame_rate_hz = 0;
  // The person whose rest pose the reply's rig has, if the request asks for rotations.
  std::optional<RigSource> rig;
};

// Appends the positions of frames, as the caller gets them. `poses`: in the model's joint order,
// level world metres.
void AppendPositions(const ReplyMapping& reply, const motion::Poses& poses,
                     google::protobuf::RepeatedField<float>* positions);
// The reverse: the frames that a caller got, in the model's joint order, level world metres.
// Requires every joint of the model in the reply.
motion::Poses FromPositions(const ReplyMapping& reply,
                            const google::protobuf::RepeatedField<float>& positions);

// Writes a rig and its poses in the caller's joints, unit, up axis and tilt.
class RigFormat {
 public:
  // Requires a reply with every joint of the model, in a unit that is the same in all directions.
  explicit RigFormat(const ReplyMapping& reply);

  void AppendRig(const retargeting::Rig& rig,
                 google::protobuf::RepeatedPtrField<v1::RigJoint>* joints) const;
  // Appends [rig joints, 4]: quaternions x, y, z, w.
  void AppendRotations(const retargeting::RigPose& pose,
                       google::protobuf::RepeatedField<float>* rotations) const;

 private:
  motion::Coordinates coordinates_;
  retargeting::Quaternion to_caller_;  // from the world's axes
  retargeting::Quaternion tilt_;       // from the follower's world to the caller's
  std::vector<int> reply_joints_;      // for each joint of the model, its index in the reply
};

// Requires a leader with at least one frame. leader: [frames, skeleton joints], metres, y up.
RigSource MakeRigSource(const motion::Skeleton& skeleton, const motion::Poses& leader,
                        double frame_rate_hz);

// The joint rotations of one reply, frame by frame, in the caller's unit, up axis and tilt. The rig
// has the leader's proportions and the bone lengths of the follower's first frame.
class ReplyRig {
 public:
  // Requires a reply as RigFormat does, with reply.rig, and a follower with at least one frame.
  ReplyRig(const ReplyMapping& reply, const motion::Poses& follower);
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

// The joint rotations of a live session. The rig has the proportions of the leader and the bone
// lengths of the follower in frame 0, so a resumed session has the same rig if its caller sends
// both frames again. Everything is computed from the follower's frames as the caller gets them.
class LiveRig {
 public:
  // leader, follower: frame 0 of both, [1, joints], in the model's joint order, level metres.
  // Requires a reply as RigFormat does.
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

#endif  // DUET_SERVER_SERVICE_REPLY_MAPPING_H_
