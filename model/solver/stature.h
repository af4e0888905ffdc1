#ifndef DUET_MODEL_SOLVER_STATURE_H_
#define DUET_MODEL_SOLVER_STATURE_H_

#include <array>
#include <vector>

#include "model/motion/poses.h"
#include "model/motion/vec3.h"
#include "model/solver/body_model.h"
#include "model/solver/footing.h"

namespace duet::solver {

// Where the legs of a body reach, before its feet are planned. Shapes: [frames].
struct Stance {
  std::array<FootPath, 2> feet;
  std::array<std::vector<float>, 2> stretch;  // from hip to foot, metres
};
Stance MeasureStance(const BodyModel& body, const motion::Poses& poses);

// Raises the lasting stretch of the legs to a share of their length: a network that continues its
// own motion can sink into a crouch and stay in it. Captured people's is .96 on average, dancers'
// .92.
void StretchLegs(const BodyModel& body, double frame_rate_hz, Stance* stance);

// Moves a body, from frame `given` on, so that its legs keep their stretch above feet that stand
// elsewhere: knees do not bend because feet were put elsewhere. The body goes along the floor where
// its standing feet went, rises or sinks, and its pelvis rolls where the two legs disagree. Feet
// that would have to be sunk to are left. Moves all joints; the legs are to be placed. `poses` has
// the body. Returns by how much the body moved. Shapes: [frames].
std::vector<motion::Vec3> StandOnFeet(const BodyModel& body, const Footing& footing,
                                      const Stance& stance, double frame_rate_hz, int given,
                                      motion::Poses* poses);

}  // namespace duet::solver

#endif  // DUET_MODEL_SOLVER_STATURE_H_
