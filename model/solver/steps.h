#ifndef DUET_MODEL_SOLVER_STEPS_H_
#define DUET_MODEL_SOLVER_STEPS_H_

#include <array>

#include "model/solver/footing.h"

namespace duet::solver {

// Plans where the two feet of a follower stand and when they step, frame by frame, from where its
// caller has them:
//
// - A foot stands until the wanted foot steps or is a step away for a while, or until its hip has
//   left it; then it steps to where the wanted foot will stand, but below its hip. Only one foot
//   steps at a time, unless both leave the floor.
// - What the feet do at first follows from the given frames alone: a foot that moved is stepping,
//   since when it moved. A plan that is made anew from its own frames therefore goes on.
//
// `wanted`, `hips`: the feet and the hips of a body whose feet were not planned; the first `given`
// frames are final. `floor`: the height of a standing foot. Shapes: all paths [frames]. Requires a
// frame.
Footing PlanSteps(const std::array<FootPath, 2>& wanted, const std::array<FootPath, 2>& hips,
                  int given, double frame_rate_hz, double floor);

}  // namespace duet::solver

#endif  // DUET_MODEL_SOLVER_STEPS_H_
