#include "server/service/reply_mapping.h"

#include <cstddef>

namespace duet::server::service {

void FillChunk(const ReplyMapping& reply, const std::vector<motion::Vec3>& frames, int model_joints,
               int first_frame, v1::MotionChunk& chunk) {
  const int frame_count = static_cast<int>(frames.size()) / model_joints;
  chunk.set_first_frame(first_frame);
  chunk.set_frame_count(frame_count);
  chunk.mutable_positions()->Reserve(frame_count * static_cast<int>(reply.joints.size()) * 3);
  for (int frame = 0; frame < frame_count; ++frame) {
    const motion::Vec3* pose = frames.data() + static_cast<std::ptrdiff_t>(frame) * model_joints;
    for (const int joint : reply.joints) {
      const motion::Vec3 position = FromWorld(reply.coordinates, pose[joint]);
      chunk.add_positions(position.x);
      chunk.add_positions(position.y);
      chunk.add_positions(position.z);
    }
  }
}

}  // namespace duet::server::service
