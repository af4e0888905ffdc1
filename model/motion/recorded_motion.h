#ifndef DUET_MODEL_MOTION_RECORDED_MOTION_H_
#define DUET_MODEL_MOTION_RECORDED_MOTION_H_

#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/coordinates.h"
#include "model/motion/skeleton.h"

namespace duet::motion {

// Positions as a file has them: the file's joints in its order, in its own unit and axes.
struct RecordedMotion {
  std::vector<Clip> people;  // one or two, the same joints and frames; frame rate 0 when unknown
  Coordinates coordinates;
  // What the file says itself; the rest are defaults.
  bool says_unit = false, says_up_axis = false;
  bool rate_from_times = false;  // the frame rate is that of a column of times
};

// Refuses what no writer can express: no frame, a rate that is no rate, a position that is not
// finite or beyond kMaxCoordinate. `name` is how the error calls the clip.
absl::Status CheckClip(absl::string_view name, const Clip& clip);
// The same for both people, who share joints, frames and rate.
absl::Status CheckPair(const ClipPair& pair);
// The same for one person or a leader and a follower, of the skeleton's joints in its order.
absl::Status CheckPeople(const std::vector<Clip>& people, const Skeleton& skeleton);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_RECORDED_MOTION_H_
