#ifndef DUET_MODEL_SOLVER_SMOOTHER_H_
#define DUET_MODEL_SOLVER_SMOOTHER_H_

#include <vector>

#include "model/motion/vec3.h"

namespace duet::solver {

// What a correction costs that is added to a motion.
struct CorrectionCost {
  double frame_rate_hz = 0;
  double seconds = 0;  // over which a correction comes and goes
  double near = 0;     // weight of the correction itself, against 1 of a wish
  int given = 0;       // the first frames that are not corrected
};

// Finds the correction d of one coordinate that follows wishes and changes smoothly:
//
//   min  sum_t weights[t] (d[t] - wishes[t])^2 + near d[t]^2 + s^2 (D d)[t]^2 + s^4 / 4 (D^2
//   d)[t]^2,   d[t] = 0 for t < given
//
// with s = seconds * frame_rate_hz. The differences of the correction are penalised, not those of
// the motion, so that the motion keeps its timing. Shapes: weights, wishes and the result [frames].
// Requires near > 0.
std::vector<double> SmoothCorrection(const CorrectionCost& cost, const std::vector<double>& weights,
                                     const std::vector<double>& wishes);
// The same for three coordinates.
std::vector<motion::Vec3> SmoothShift(const CorrectionCost& cost,
                                      const std::vector<double>& weights,
                                      const std::vector<motion::Vec3>& wishes);

}  // namespace duet::solver

#endif  // DUET_MODEL_SOLVER_SMOOTHER_H_
