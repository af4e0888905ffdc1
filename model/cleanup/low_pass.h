#ifndef DUET_MODEL_CLEANUP_LOW_PASS_H_
#define DUET_MODEL_CLEANUP_LOW_PASS_H_

#include <vector>

#include "model/motion/vec3.h"

namespace duet::cleanup {

// Smooths a track over time with a Gaussian, truncated at three standard deviations and
// renormalised at the ends. Returns as many frames as `track` has.
std::vector<float> LowPass(const std::vector<float>& track, double sigma_frames);
std::vector<motion::Vec3> LowPass(const std::vector<motion::Vec3>& track, double sigma_frames);

// Returns, for each frame, the maximum within `reach` frames on either side.
std::vector<float> MostAround(const std::vector<float>& track, int reach);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_LOW_PASS_H_
