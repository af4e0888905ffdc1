#ifndef DUET_MODEL_MOTION_RESAMPLE_H_
#define DUET_MODEL_MOTION_RESAMPLE_H_

#include "absl/types/span.h"
#include "model/motion/poses.h"
#include "model/motion/vec3.h"

namespace duet::motion {

// Frames that a motion of `frames` at `from_hz` has at `to_hz`: enough to cover its whole duration,
// so the last one may lie past the end. At least 2. Positive rates, frames >= 2.
int ResampledFrameCount(int frames, double from_hz, double to_hz);

// Writes the pose at a fractional frame, linearly between neighbours and held at both ends.
// Requires at least one frame. Shapes: out [joints].
void SampleLinear(const Poses& poses, double frame, absl::Span<Vec3> out);

// The same through a Catmull-Rom spline: continuous velocity, so that a reply at a higher rate than
// the network's shows no kinks.
void SampleCubic(const Poses& poses, double frame, absl::Span<Vec3> out);

// A whole motion at another rate (linear), ResampledFrameCount frames.
Poses Resample(const Poses& poses, double from_hz, double to_hz);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_RESAMPLE_H_
