#ifndef DUET_MODEL_MOTION_RECORDED_MOTION_H_
#define DUET_MODEL_MOTION_RECORDED_MOTION_H_

#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/coordinates.h"
#include "model/motion/skeleton.h"

namespace duet::motion {

// Positions as stored in a file: its joints in its order, in its own unit and axes.
struct RecordedMotion {
  std::vector<Clip> people;  // one or two, with the same joints and frames; frame rate 0 if unknown
  Coordinates coordinates;
  bool says_unit = false, says_up_axis = false;  // false: the value in `coordinates` is a default
};

// INVALID_ARGUMENT for clips that no writer can express: no frames, a frame rate out of range, or a
// position that is not finite or beyond kMaxCoordinate. `name` denotes the clip in the message.
absl::Status CheckClip(absl::string_view name, const Clip& clip);
// The same for two people, who must have the same joints, frames and frame rate.
absl::Status CheckPair(const ClipPair& pair);
// The same for one person or a leader and a follower, who must have the skeleton's joints in its
// order.
absl::Status CheckPeople(const std::vector<Clip>& people, const Skeleton& skeleton);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_RECORDED_MOTION_H_
