#include "server/service/reply_mapping.h"

#include <cstddef>

namespace duet::server::service {

void FillChunk(const ReplyMapping& reply, const motion::Poses& poses, int first_frame,
               v1::MotionChunk& chunk) {
  chunk.set_first_frame(first_frame);
  chunk.set_frame_count(poses.frame_count());
  chunk.mutable_positions()->Reserve(poses.frame_count() * static_cast<int>(reply.joints.size()) *
                                     3);
  for (int frame = 0; frame < poses.frame_count(); ++frame) {
    for (const int joint : reply.joints) {
      const motion::Vec3 level = poses.at(frame, joint);
      const motion::Vec3 world = reply.levelling ? reply.levelling->Invert(level) : level;
      const motion::Vec3 position = FromWorld(reply.coordinates, world);
      chunk.add_positions(position.x);
      chunk.add_positions(position.y);
      chunk.add_positions(position.z);
    }
  }
}

}  // namespace duet::server::service
