#ifndef DUET_SERVER_SERVICE_RIG_FORMAT_H_
#define DUET_SERVER_SERVICE_RIG_FORMAT_H_

#include <google/protobuf/repeated_field.h>

#include <optional>
#include <vector>

#include "duet/v1/motion.pb.h"
#include "model/motion/coordinates.h"
#include "model/motion/levelling.h"
#include "model/retargeting/pose_fitting.h"
#include "model/retargeting/rig.h"
#include "model/retargeting/rotation.h"

namespace duet::server::service {

// Writes a rig and its poses in the caller's joints, unit, up axis and tilt.
class RigFormat {
 public:
  // joints: for each joint of the reply, its index in the model; all of the model's, in any order.
  // Requires a unit that is the same in all directions. `levelling`: from the caller's world to the
  // follower's.
  RigFormat(const motion::Coordinates& coordinates,
            const std::optional<motion::Levelling>& levelling, const std::vector<int>& joints);

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

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_RIG_FORMAT_H_
