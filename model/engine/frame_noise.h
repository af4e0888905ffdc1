#ifndef DUET_MODEL_ENGINE_FRAME_NOISE_H_
#define DUET_MODEL_ENGINE_FRAME_NOISE_H_

#include <cstdint>
#include <vector>

#include "absl/types/span.h"

// Noise of an endless motion (Sampling::first_frame): that of a frame depends only on the seed and
// the frame's index, so that windows that overlap have the same noise where they do.
namespace duet::engine {

// The frame of numbers that are the same for the whole motion.
inline constexpr int64_t kEveryFrame = INT64_MIN;

// Fills `out` with the uniform numbers of a frame, in (0, 1). A prefix does not depend on the size.
void FrameUniforms(uint64_t seed, int64_t frame, absl::Span<double> out);

// Returns the weights [2 reach + 1] that turn independent noise into noise whose frames at distance
// d have the covariance exp(-(d / length)^2 / 2), by a weighted sum over the neighbours.
std::vector<float> SmoothingWeights(double length);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_FRAME_NOISE_H_
