#ifndef DUET_MODEL_FORMATS_RECORDED_MOTION_H_
#define DUET_MODEL_FORMATS_RECORDED_MOTION_H_

#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/coordinates.h"

namespace duet {

// Positions as a file has them: the file's joints in its order, in its own unit and axes.
struct RecordedMotion {
  std::vector<Clip> people;  // one or two, the same joints and frames; frame rate 0 when unknown
  CoordinateFrame coordinates;
};

// Refuses a pair whose people differ in joints, frames or rate, or hold no finite positions: what
// no writer can express.
absl::Status CheckPair(const ClipPair& pair);

}  // namespace duet

#endif  // DUET_MODEL_FORMATS_RECORDED_MOTION_H_
