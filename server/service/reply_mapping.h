#ifndef DUET_SERVER_SERVICE_REPLY_MAPPING_H_
#define DUET_SERVER_SERVICE_REPLY_MAPPING_H_

#include <optional>
#include <string>
#include <vector>

#include "duet/v1/motion.pb.h"
#include "duet/v1/synthesis.pb.h"
#include "model/motion/coordinates.h"
#include "model/motion/levelling.h"
#include "model/motion/poses.h"
#include "server/service/reply_rig.h"

namespace duet::server::service {

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

// Fills in a chunk. `poses`: in the model's joint order, level world metres.
void FillChunk(const ReplyMapping& reply, const motion::Poses& poses, int first_frame,
               v1::MotionChunk& chunk);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_REPLY_MAPPING_H_
