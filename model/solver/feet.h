#ifndef DUET_MODEL_SOLVER_FEET_H_
#define DUET_MODEL_SOLVER_FEET_H_

#include <array>
#include <vector>

#include "model/body/limbs.h"
#include "model/motion/poses.h"
#include "model/motion/vec3.h"

namespace duet::solver {

// The path of one foot. Shapes: [frames]. Units: metres, y up.
using FootPath = std::vector<motion::Vec3>;

// When the feet stand, and where.
struct Footing {
  std::array<FootPath, 2> paths;              // at rest while the foot stands, otherwise its own
  std::array<std::vector<bool>, 2> standing;  // whether the foot is at rest
};

// In which frames two feet stand: by hysteresis of speed and height, both without noise. Of two
// swinging feet that are low and slow, the one more at rest stands: people jump and run, but do not
// glide. `floor` is the height of a standing foot. Requires a frame. Shapes: returns
// [feet][frames].
std::array<std::vector<bool>, 2> FindStanding(const std::array<FootPath, 2>& feet,
                                              double frame_rate_hz, double floor);

// Finds where two captured feet stand:
//
// 1. A foot stands or swings as FindStanding has it.
// 2. The places of a stand are piecewise constant: a dynamic programme weighs the distance from the
//    feet against the number of places. It changes the place only while the other foot stands.
// 3. A stand has one height, near the floor.
//
// `floor` is the height of a standing foot. Requires at least one frame, as many for both feet.
Footing PlanFooting(const std::array<FootPath, 2>& feet, double frame_rate_hz, double floor);

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

#endif  // DUET_MODEL_SOLVER_FEET_H_
