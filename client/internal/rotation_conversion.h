#ifndef DUET_CLIENT_INTERNAL_ROTATION_CONVERSION_H_
#define DUET_CLIENT_INTERNAL_ROTATION_CONVERSION_H_

#include <google/protobuf/repeated_field.h>

#include <cstddef>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "duet/v1/motion.pb.h"
#include "model/motion/joint_rotations.h"

// The rig and the rotations of a reply. Errors: INVALID_ARGUMENT naming the field of the reply.
namespace duet::client::internal {

// `field`: that of the rig in the reply. Fails unless the first joint is the only root, every
// parent comes before its children, names are unique, offsets are finite, and joints are in [0,
// joint_count).
absl::StatusOr<std::vector<motion::RestJoint>> ReadRig(
    const std::string& field, const google::protobuf::RepeatedPtrField<v1::RigJoint>& rig,
    int joint_count);

// Fails unless `values` has a unit quaternion for each of `frames` and each of `rig_joints`.
absl::Status CheckRotations(const std::string& field,
                            const google::protobuf::RepeatedField<float>& values,
                            std::size_t frames, std::size_t rig_joints);

// Requires values that CheckRotations accepts.
void AppendRotations(const google::protobuf::RepeatedField<float>& values,
                     std::vector<motion::UnitQuaternion>* rotations);

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_ROTATION_CONVERSION_H_
