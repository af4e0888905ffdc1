#ifndef DUET_MODEL_MOTION_RESAMPLE_H_
#define DUET_MODEL_MOTION_RESAMPLE_H_

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "absl/types/span.h"
#include "model/motion/clip.h"
#include "model/motion/poses.h"
#include "model/motion/vec3.h"

namespace duet::motion {

// The number of frames at `to_hz` of a motion of `frames` frames at `from_hz`, at least 2. They
// cover the whole duration: the last one may be past the end. Requires positive rates and frames
// >= 2.
int ResampledFrameCount(int frames, double from_hz, double to_hz);

// Writes the pose at a fractional frame: linear interpolation, constant beyond both ends.
// Requires at least one frame. Shapes: out [joints].
void SampleLinear(const Poses& poses, double frame, absl::Span<Vec3> out);

// The same by a Catmull-Rom spline. Its velocity is continuous, so that a reply at a higher rate
// than the network's has no kinks.
void SampleCubic(const Poses& poses, double frame, absl::Span<Vec3> out);

// The `count` frames from frame `first` on.
Poses Part(const Poses& poses, int first, int count);

// A whole motion at another rate, interpolated linearly, with ResampledFrameCount frames.
Poses Resample(const Poses& poses, double from_hz, double to_hz);

// A clip at another rate, interpolated by the spline, from its first frame to the last one that is
// not after its end.
//
// Errors: INVALID_ARGUMENT naming `field`, where the rate comes from, for a rate that no motion has
//         or that makes more than kMaxMotionFrames frames.
absl::Status ResampleByRate(absl::string_view field, double rate_hz, Clip* clip);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_RESAMPLE_H_
