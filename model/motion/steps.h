#ifndef DUET_MODEL_MOTION_STEPS_H_
#define DUET_MODEL_MOTION_STEPS_H_

#include <limits>
#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// When people step. Units: metres, seconds.

namespace duet::motion {

// The speed at which a joint arrives at a frame, m/s; 0 in the first frame.
double SpeedAt(const Poses& poses, int frame, int joint, double frame_rate_hz);

// The times at which a foot comes to rest, ascending: its speed, without noise, falls below
// 0.3 m/s.
std::vector<double> FindSteps(const JointPair& feet, const Poses& person, double frame_rate_hz);

// How steps fall on other times, such as beats or the steps of a partner.
struct StepTiming {
  int steps = 0;
  double mean_distance = 0;  // of a step from the nearest time; NaN without steps or times
  // Standard deviation of the signed time from each step to the nearest time, so that a constant
  // delay does not count; NaN for fewer than 2 steps or without times.
  double spread = 0;
  int far = 0;  // steps that are farther than `farthest` from every time; no other figure has them
};
// Requires ascending `times`.
StepTiming MeasureStepTiming(const std::vector<double>& steps, const std::vector<double>& times,
                             double farthest = std::numeric_limits<double>::infinity());

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_STEPS_H_
