#ifndef DUET_SERVER_SERVICE_REPLY_MAPPING_H_
#define DUET_SERVER_SERVICE_REPLY_MAPPING_H_

#include <optional>
#include <string>
#include <vector>

#include "duet/v1/motion.pb.h"
#include "duet/v1/synthesis.pb.h"
#include "model/motion/coordinates.h"
#include "model/motion/poses.h"
#include "server/service/reply_rig.h"

namespace duet::server::service {

// Maps the model's follower to the caller's joints, order, unit and up axis.
struct ReplyMapping {
  motion::Coordinates coordinates;
  std::vector<int> joints;               // for each joint of the reply, its index in the model
  std::vector<std::string> joint_names;  // of the reply
  // Those of the leader, repeated in the header.
  v1::LengthUnit unit = v1::LENGTH_UNIT_UNSPECIFIED;
  v1::UpAxis up_axis = v1::UP_AXIS_UNSPECIFIED;
  double frame_rate_hz = 0;
  // The person whose rest pose the reply's rig has, if the request asks for rotations.
  std::optional<RigSource> rig;
};

// Fills in a chunk. `poses`: in the model's joint order, world metres.
void FillChunk(const ReplyMapping& reply, const motion::Poses& poses, int first_frame,
               v1::MotionChunk& chunk);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_REPLY_MAPPING_H_
