#ifndef DUET_MODEL_MOTION_CLIP_H_
#define DUET_MODEL_MOTION_CLIP_H_

#include <cstddef>
#include <string>
#include <vector>

#include "model/motion/vec3.h"

namespace duet::motion {

// The motion of one character.
//
// Shapes: positions [frames, joints], row-major (all joints of frame 0 first).
// Units:  metres, right-handed, y up, frames a second.
struct Clip {
  std::vector<std::string> joint_names;
  double frame_rate_hz = 0;
  std::vector<Vec3> positions;

  int joint_count() const { return static_cast<int>(joint_names.size()); }
  int frame_count() const {
    return joint_names.empty() ? 0 : static_cast<int>(positions.size() / joint_names.size());
  }
  Vec3& at(int frame, int joint) { return positions[Index(frame, joint)]; }
  const Vec3& at(int frame, int joint) const { return positions[Index(frame, joint)]; }
  const Vec3* frame(int index) const { return positions.data() + Index(index, 0); }

 private:
  std::size_t Index(int frame, int joint) const {
    return static_cast<std::size_t>(frame) * joint_names.size() + static_cast<std::size_t>(joint);
  }
};

// Two characters captured or synthesised together: same frame rate, frames and world frame.
struct ClipPair {
  Clip leader;
  Clip follower;
};

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_CLIP_H_
