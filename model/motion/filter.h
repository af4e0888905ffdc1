#ifndef DUET_MODEL_MOTION_FILTER_H_
#define DUET_MODEL_MOTION_FILTER_H_

#include "model/motion/poses.h"

// Taking measuring noise out of captured motion.

namespace duet::motion {

// Smooths every joint over time with a Gaussian, cut off at three standard deviations. Beyond both
// ends the motion goes on reflected about its end point, so that a steady motion keeps its speed
// and its ends. `sigma_frames` of 0 or less returns the poses as they are.
// Shapes: returns as many frames and joints as came.
Poses GaussianFilter(const Poses& poses, double sigma_frames);

// Puts a joint that jumps away and back at once where its neighbouring frames have it: a tracker
// that loses a hand for a frame. Returns how many joints of frames were repaired.
//
// A joint is repaired (Hampel's rule) where it is farther from the median of its five frames around
// than 6 times the median of those five distances, the spread of the motion itself, and farther
// than 10 cm. The extreme frame of a fast punch stays: its neighbours are on their way.
// A motion of fewer than three frames stays as it is.
// Units: metres.
int RepairJumps(Poses* poses);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_FILTER_H_
