#include "server/service/rig_format.h"

#include <cstddef>
#include <cstdint>

#include "model/retargeting/character_rig.h"

namespace duet::server::service {
namespace {

// The rotation that Levelling::Invert applies.
retargeting::Quaternion TiltOf(const std::optional<motion::Levelling>& levelling) {
  if (!levelling) return {};
  const motion::Vec3 up = levelling->up();
  return retargeting::ShortestArc({0, 1, 0}, {up.x, up.y, up.z}, {1, 0, 0});
}

std::vector<int> Inverse(const std::vector<int>& joints) {
  std::vector<int> inverse(joints.size());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    inverse[static_cast<std::size_t>(joints[i])] = static_cast<int>(i);
  }
  return inverse;
}

}  // namespace

RigFormat::RigFormat(const motion::Coordinates& coordinates,
                     const std::optional<motion::Levelling>& levelling,
                     const std::vector<int>& joints)
    : coordinates_(coordinates),
      to_caller_(retargeting::Inverse(retargeting::ToWorldAxes(coordinates.up_axis))),
      tilt_(TiltOf(levelling)),
      reply_joints_(Inverse(joints)) {}

void RigFormat::AppendRig(const retargeting::Rig& rig,
                          google::protobuf::RepeatedPtrField<v1::RigJoint>* joints) const {
  for (const retargeting::RigJoint& joint : rig.joints) {
    v1::RigJoint& added = *joints->Add();
    added.set_name(joint.name);
    added.set_parent(joint.parent);
    added.set_joint(static_cast<uint32_t>(reply_joints_[static_cast<std::size_t>(joint.joint)]));
    const motion::Vec3 offset = FromWorld(coordinates_, ToFloat(joint.offset));
    added.mutable_offset()->set_x(offset.x);
    added.mutable_offset()->set_y(offset.y);
    added.mutable_offset()->set_z(offset.z);
  }
}

void RigFormat::AppendRotations(const retargeting::RigPose& pose,
                                google::protobuf::RepeatedField<float>* rotations) const {
  for (std::size_t j = 0; j < pose.rotations.size(); ++j) {
    const retargeting::Quaternion q = j == 0 ? tilt_ * pose.rotations[j] : pose.rotations[j];
    const retargeting::Vec3d axis = Rotate(to_caller_, {q.x, q.y, q.z});
    for (const double value : {axis.x, axis.y, axis.z, q.w}) {
      rotations->Add(static_cast<float>(value));
    }
  }
}

}  // namespace duet::server::service
