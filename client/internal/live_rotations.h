#ifndef DUET_CLIENT_INTERNAL_LIVE_ROTATIONS_H_
#define DUET_CLIENT_INTERNAL_LIVE_ROTATIONS_H_

#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "duet/v1/live.pb.h"
#include "model/motion/joint_rotations.h"

namespace duet::client::internal {

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

#endif  // DUET_CLIENT_INTERNAL_LIVE_ROTATIONS_H_
