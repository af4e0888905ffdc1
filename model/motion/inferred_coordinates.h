#ifndef DUET_MODEL_MOTION_INFERRED_COORDINATES_H_
#define DUET_MODEL_MOTION_INFERRED_COORDINATES_H_

#include <optional>
#include <vector>

#include "model/motion/coordinates.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// Infers the length unit and the up axis of captured people from their bodies. This is the only
// rule: every reader, `duet-import` and the skeleton check use it
// (docs/decisions/captures.md).

namespace duet::motion {

// The range of a person's leg length, metres. Both ends belong to it.
inline constexpr double kShortestLeg = 0.7, kLongestLeg = 1.4;
bool IsLegLength(double metres);

// The length of the bones from a foot to the root, averaged over both legs. Each bone has its
// median length over all frames.
//
// Requires feet, at least one frame and a skeleton that Validate accepts. Units: those of poses.
double LegLength(const Skeleton& skeleton, const Poses& poses);

struct InferredUnit {
  const char* name;
  double metres;  // in one unit
};

// The first of centimetres, metres, millimetres, inches, CMU's unit and decimetres in which the
// median of `leg_lengths` is a person's. Absent if none fits. Only CMU's unit and decimetres
// overlap: legs of 12.4 to 14 units are taken for CMU's.
//
// Requires at least one length. All lengths are in the same unknown unit.
std::optional<InferredUnit> InferUnit(std::vector<double> leg_lengths);

// The axis along which people stand: y, z or -y, whichever is nearest to the mean direction from
// the feet to the root over all frames of all people. Absent if x, -x or -z is nearer, if there is
// no such direction, or if the skeleton has no feet.
std::optional<UpAxis> InferUpAxis(const Skeleton& skeleton,
                                  const std::vector<const Poses*>& people);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_INFERRED_COORDINATES_H_
