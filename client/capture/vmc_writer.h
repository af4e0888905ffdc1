#ifndef DUET_CLIENT_CAPTURE_VMC_WRITER_H_
#define DUET_CLIENT_CAPTURE_VMC_WRITER_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"
#include "model/retargeting/joint_mapping.h"
#include "model/retargeting/rig.h"
#include "model/retargeting/rig_fitting.h"

namespace duet::client::capture {

// Writes a motion as the Virtual Motion Capture protocol (VMC): bones relative to their parents, in
// Unity's left-handed axes.
//
// Seventeen bones are sent: those of Unity's humanoid without shoulders, upper chest, toes and
// fingers, which the positions of joints do not define. Their rotations are relative to the T pose,
// as for avatars of VRM. Their positions are those of the motion, so that a receiver that uses them
// has every joint exactly at its place.
class VmcWriter {
 public:
  // A datagram is not fragmented on usual networks.
  static constexpr std::size_t kMaxBundleBytes = 1400;

  // `joint_names` is mapped to the humanoid's joints by name, with the first pose.
  VmcWriter(std::vector<std::string> joint_names, double frame_rate_hz);
  VmcWriter(const VmcWriter&) = delete;
  VmcWriter& operator=(const VmcWriter&) = delete;

  // The datagrams of one frame. positions: [joint_names], metres, y up. seconds: any clock.
  // Errors: INVALID_ARGUMENT naming the joints that the motion lacks.
  absl::StatusOr<std::vector<std::string>> Write(absl::Span<const motion::Vec3> positions,
                                                 double seconds);

 private:
  // A bone that is sent, and its joint on the rig.
  struct SentBone {
    const char* name = nullptr;
    std::size_t rig_joint = 0;
    int parent = -1;  // an earlier sent bone
  };

  const std::vector<std::string> names_;
  const motion::Skeleton skeleton_;
  const retargeting::Rig rig_;
  std::vector<SentBone> bones_;
  retargeting::RigFitter fitter_;
  std::optional<retargeting::JointMap> map_;
};

}  // namespace duet::client::capture

#endif  // DUET_CLIENT_CAPTURE_VMC_WRITER_H_
