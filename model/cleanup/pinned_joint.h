#ifndef DUET_MODEL_CLEANUP_PINNED_JOINT_H_
#define DUET_MODEL_CLEANUP_PINNED_JOINT_H_

#include <vector>

#include "absl/types/span.h"
#include "model/body/limbs.h"
#include "model/cleanup/offset_track.h"
#include "model/motion/pin.h"
#include "model/motion/poses.h"
#include "model/motion/resample.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

// Returns where the joint of a pin is at the pin's time. `pose` receives all joints.
inline motion::Vec3 JointAt(const motion::Poses& poses, const motion::Pin& pin,
                            std::vector<motion::Vec3>* pose) {
  pose->resize(static_cast<std::size_t>(poses.joint_count()));
  SampleCubic(poses, pin.frame, absl::MakeSpan(*pose));
  return (*pose)[static_cast<std::size_t>(pin.joint)];
}
inline motion::Vec3 JointAt(const motion::Poses& poses, const motion::Pin& pin) {
  std::vector<motion::Vec3> pose;
  return JointAt(poses, pin, &pose);
}

// Returns the ways from the joints to their pins.
inline std::vector<Offset> OffsetsTo(const motion::Pins& pins, const motion::Poses& poses) {
  std::vector<Offset> offsets;
  for (const motion::Pin& pin : pins) {
    offsets.push_back({pin.frame, pin.position - JointAt(poses, pin)});
  }
  return offsets;
}

// Returns the direction in which a body faces; zero without hips.
inline motion::Vec3 FacingOf(const motion::Skeleton& skeleton,
                             absl::Span<const motion::Vec3> pose) {
  return skeleton.hips ? body::Facing(*skeleton.hips, pose) : motion::Vec3{};
}

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_PINNED_JOINT_H_
