#ifndef DUET_CLIENT_INTERNAL_ROTATION_CONVERSION_H_
#define DUET_CLIENT_INTERNAL_ROTATION_CONVERSION_H_

#include <cstddef>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "duet/v1/synthesis.pb.h"
#include "model/motion/joint_rotations.h"

// The rig and the rotations of a reply. Errors: INVALID_ARGUMENT naming the field of the reply.
namespace duet::client::internal {

// Fails unless the first joint is the only root, every parent comes before its children, names are
// unique, offsets are finite, and joints are in [0, joint_count).
absl::StatusOr<std::vector<motion::RestJoint>> ReadRig(
    const google::protobuf::RepeatedPtrField<v1::RigJoint>& rig, int joint_count);

// Fails unless a chunk has a unit quaternion for each frame and each of `rig_joints`.
absl::Status CheckRotations(const v1::MotionChunk& chunk, std::size_t rig_joints);

// Requires a chunk that CheckRotations accepts.
void AppendRotations(const v1::MotionChunk& chunk, std::vector<motion::UnitQuaternion>* rotations);

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_ROTATION_CONVERSION_H_
