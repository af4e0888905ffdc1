#ifndef DUET_CLIENT_INTERNAL_ROTATIONS_H_
#define DUET_CLIENT_INTERNAL_ROTATIONS_H_

#include <google/protobuf/repeated_field.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "duet/v1/live.pb.h"
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

// Reads the joint rotations of a live session over all its streams. The wire has every quaternion
// with w >= 0; the caller gets each with the sign that is nearer to the frame before.
class LiveRotations {
 public:
  // wanted: whether the session asked for rotations. If not, a message that has some is an error.
  LiveRotations(bool wanted, int joint_count) : wanted_(wanted), joint_count_(joint_count) {}

  // The next message is the first one of a stream, which has the rig.
  void BeginStream() { has_rig_ = false; }

  // Returns the rotations of a message's frames from `known` on; absent if they are not wanted.
  // Errors: INVALID_ARGUMENT naming the field of the message.
  absl::StatusOr<std::optional<motion::JointRotations>> Read(const v1::FollowerFrames& frames,
                                                             int known);

 private:
  const bool wanted_;
  const int joint_count_;
  bool has_rig_ = false;  // of this stream
  std::vector<motion::RestJoint> rig_;
  std::vector<motion::UnitQuaternion> last_;  // of the last frame
};

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_ROTATIONS_H_
