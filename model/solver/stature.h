#ifndef DUET_MODEL_SOLVER_STATURE_H_
#define DUET_MODEL_SOLVER_STATURE_H_

#include <vector>

#include "model/body/limbs.h"
#include "model/motion/poses.h"
#include "model/solver/footing.h"

namespace duet::solver {

// The share of its length to which each leg is stretched: 1 for a straight one.
// Shapes: returns [legs][frames].
using Stretches = std::vector<std::vector<float>>;
Stretches MeasureStretches(const std::vector<body::Limb>& legs, const motion::Poses& poses);

// Raises or lowers a body so that the legs it stands on are stretched as far as `wanted` when their
// feet are where `footing` has them: knees do not bend because feet were put elsewhere. A network
// that continues its own motion can sink into a crouch and stay in it, so lasting hip heights are
// bounded. Moves all joints, the feet with them, from frame `given` on. Requires two legs. Shapes:
// wanted [legs][frames].
void KeepStature(const std::vector<body::Limb>& legs, const Footing& footing,
                 const Stretches& wanted, double frame_rate_hz, int given, motion::Poses* poses);

}  // namespace duet::solver

#endif  // DUET_MODEL_SOLVER_STATURE_H_
