#include "server/service/reply_mapping.h"

#include <cstddef>

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

void FillChunk(const ReplyMapping& reply, const motion::Poses& poses, int first_frame,
               v1::MotionChunk& chunk) {
  chunk.set_first_frame(first_frame);
  chunk.set_frame_count(poses.frame_count());
  AppendPositions(reply, poses, chunk.mutable_positions());
}

}  // namespace duet::server::service
