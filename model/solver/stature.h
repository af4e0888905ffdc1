#ifndef DUET_MODEL_SOLVER_STATURE_H_
#define DUET_MODEL_SOLVER_STATURE_H_

#include <vector>

#include "model/body/limbs.h"
#include "model/motion/poses.h"

namespace duet::solver {

// The share of its length to which each leg is stretched: 1 for a straight one.
// Shapes: returns [legs][frames].
using Stretches = std::vector<std::vector<float>>;
Stretches MeasureStretches(const std::vector<body::Limb>& legs, const motion::Poses& poses);

// How high the hips are above the lower foot in every frame, in lengths of the leg: 1 for straight
// legs. Smoothed over about a second, so that a short dip does not count. Requires two legs.
// Shapes: returns [frames].
std::vector<float> LastingHipHeights(const std::vector<body::Limb>& legs,
                                     const motion::Poses& poses, double frame_rate_hz);

struct StatureOptions {
  double frame_rate_hz = 0;
  int settled = 0;  // first frames that stay as they are
  // Lasting hip heights are at least this. Captured people stand at .96 on average, dancers at .92.
  double least_height = 0.9;
};

// Raises or lowers a body above its feet, so that the legs it stands on are stretched as far as
// `wanted`: knees do not bend because feet were put elsewhere. A network that continues its own
// motion can sink into a crouch and stay in it, so lasting hip heights are bounded. The feet keep
// their places. Does nothing without two legs. Shapes: wanted [legs][frames].
void KeepStature(const std::vector<body::Limb>& legs, const Stretches& wanted,
                 const StatureOptions& options, motion::Poses* poses);

}  // namespace duet::solver

#endif  // DUET_MODEL_SOLVER_STATURE_H_
