#ifndef DUET_MODEL_CLEANUP_TURNS_H_
#define DUET_MODEL_CLEANUP_TURNS_H_

#include <vector>

#include "model/cleanup/timing.h"
#include "model/motion/vec3.h"

namespace duet::cleanup {

// How far something turns in a frame at this speed, radians.
float MostInAFrame(double degrees_per_second, const Timing& timing);

// Limits how far a track of directions, each of length 1, turns in a frame: `most` radians. A
// faster turn takes more time for it, before and after. Frames before `first` do not change, nor
// does a track without fast turns.
void LimitTurns(int first, float most, std::vector<motion::Vec3>* track);

// The same for a track of numbers: limits how far it rises or falls in a frame.
void LimitSlopes(int first, float most, std::vector<float>* track);

// The same for a point that moves: the longest way in a frame, metres.
void LimitSteps(int first, float most, std::vector<motion::Vec3>* track);

// `from` turned towards `to`, both of length 1, by at most `most` radians; `to` itself if that is
// enough.
motion::Vec3 TurnTowards(motion::Vec3 from, motion::Vec3 to, float most);

// `v` after the shortest turn that takes `from` to `to`, both of length 1. Opposite directions have
// no shortest turn: `v` does not change.
motion::Vec3 Carried(motion::Vec3 from, motion::Vec3 to, motion::Vec3 v);

// The angle from `a` to `b` about `axis`, -pi to pi; all of length 1, `axis` across both.
float SignedAngle(motion::Vec3 a, motion::Vec3 b, motion::Vec3 axis);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_TURNS_H_
