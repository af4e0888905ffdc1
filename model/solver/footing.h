#ifndef DUET_MODEL_SOLVER_FOOTING_H_
#define DUET_MODEL_SOLVER_FOOTING_H_

#include <array>
#include <vector>

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

}  // namespace duet::solver

#endif  // DUET_MODEL_SOLVER_FOOTING_H_
