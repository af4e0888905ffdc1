#ifndef DUET_MODEL_MOTION_FILTER_H_
#define DUET_MODEL_MOTION_FILTER_H_

#include "model/motion/poses.h"

// Filters that remove measurement noise from captured motion.

namespace duet::motion {

// Smooths every joint over time with a Gaussian, truncated at three standard deviations. Beyond
// each end the motion is continued by its reflection about the end point, so that a steady motion
// keeps its speed and its end points. If `sigma_frames` is 0 or less, the poses are returned
// unchanged. Shapes: returns the same frames and joints.
Poses GaussianFilter(const Poses& poses, double sigma_frames);

// The standard deviation of WithoutNoise: 1.5 frames at SBU's 15 Hz.
inline constexpr double kNoiseFilterSeconds = 0.1;

// Returns the motion smoothed by a Gaussian of kNoiseFilterSeconds.
Poses WithoutNoise(const Poses& poses, double frame_rate_hz);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_FILTER_H_
