#ifndef DUET_MODEL_MOTION_CLIP_H_
#define DUET_MODEL_MOTION_CLIP_H_

#include <string>
#include <vector>

#include "absl/types/span.h"
#include "model/motion/poses.h"
#include "model/motion/vec3.h"

namespace duet::motion {

// The motion of one character: poses with the names of their joints and a rate.
//
// Units: metres, right-handed, y up, frames a second.
struct Clip {
  std::vector<std::string> joint_names;
  double frame_rate_hz = 0;
  Poses poses;  // of as many joints as there are names

  int joint_count() const { return static_cast<int>(joint_names.size()); }
  int frame_count() const { return poses.frame_count(); }
  Vec3& at(int frame, int joint) { return poses.at(frame, joint); }
  const Vec3& at(int frame, int joint) const { return poses.at(frame, joint); }

  // Adds whole frames at the end, joints in the order of joint_names.
  void Append(absl::Span<const Vec3> frames) {
    if (poses.empty()) poses = Poses(0, joint_count());
    poses.Append(frames);
  }
};

// Two characters captured or synthesised together: same frame rate, frames and world.
struct ClipPair {
  Clip leader;
  Clip follower;
};

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_CLIP_H_
