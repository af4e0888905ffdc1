#ifndef DUET_MODEL_MOTION_CLIP_H_
#define DUET_MODEL_MOTION_CLIP_H_

#include <string>
#include <vector>

#include "absl/types/span.h"
#include "model/motion/poses.h"
#include "model/motion/vec3.h"

namespace duet::motion {

// The motion of one character: poses, the names of their joints and a frame rate.
//
// Units: metres, right-handed, y up; frames per second.
struct Clip {
  std::vector<std::string> joint_names;
  double frame_rate_hz = 0;
  Poses poses;  // [frames, joint_names]

  int joint_count() const { return static_cast<int>(joint_names.size()); }
  int frame_count() const { return poses.frame_count(); }
  Vec3& at(int frame, int joint) { return poses.at(frame, joint); }
  const Vec3& at(int frame, int joint) const { return poses.at(frame, joint); }

  // Appends whole frames, with joints in the order of joint_names.
  void Append(absl::Span<const Vec3> frames) {
    if (poses.empty()) poses = Poses(0, joint_count());
    poses.Append(frames);
  }
};

// Two characters captured or synthesised together: the same frame rate, number of frames and world.
struct ClipPair {
  Clip leader;
  Clip follower;
};

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_CLIP_H_
