#ifndef DUET_MODEL_IMPORTING_SCALE_H_
#define DUET_MODEL_IMPORTING_SCALE_H_

#include <optional>
#include <string>
#include <vector>

#include "model/motion/coordinates.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// In which unit and along which axis people were written down, told by their bodies.
namespace duet::importing {

// Along the bones from foot to root, both legs' mean over a motion's first frame, in its own unit.
// Requires feet.
double LegLength(const motion::Skeleton& skeleton, const motion::Poses& poses);

// Legs that count as a person's, metres.
inline constexpr double kShortestLeg = 0.7, kLongestLeg = 1.4;

struct Unit {
  double metres = 1;
  std::string name;
};
// The unit in which most legs (in any unit, one or more) are a person's: metres, centimetres,
// millimetres, inches or CMU's. Nothing where there is none.
std::optional<Unit> FindUnit(std::vector<double> legs);

// The axis along which people stand: the mean direction from feet to root over all frames.
// Nothing where that is not one of the three (y, z, -y). Requires feet.
std::optional<motion::UpAxis> FindUpAxis(const motion::Skeleton& skeleton,
                                         const std::vector<const motion::Poses*>& people);

}  // namespace duet::importing

#endif  // DUET_MODEL_IMPORTING_SCALE_H_
