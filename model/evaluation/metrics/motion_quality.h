#ifndef DUET_MODEL_EVALUATION_METRICS_MOTION_QUALITY_H_
#define DUET_MODEL_EVALUATION_METRICS_MOTION_QUALITY_H_

#include <vector>

#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

// Figures of one motion by itself. Captured motion is not perfect either (Kinect's bones breathe by
// a tenth): read each beside the captured follower's own value.
//
// Shapes: positions [frames, joints], world metres, y up.

namespace duet::evaluation::metrics {

// The mean over bones of (standard deviation over time) / (mean over time) of the bone's length.
// 0 for a body whose bones keep their lengths. Dimensionless. Bones of mean length 0 count as 0.
double BoneLengthDrift(const std::vector<motion::Vec3>& positions,
                       const motion::Skeleton& skeleton);

// The mean over joints and frames of the norm of the third difference, times rate^3. Unit: m/s^3.
// 0 for fewer than four frames.
double Jitter(const std::vector<motion::Vec3>& positions, int joints, double frame_rate_hz);

// How feet move while they should stand. Both consider the time a foot spends within 5 cm of the
// lowest point that either foot reaches, and movement along the floor alone.
// A skeleton without feet has none of these: NaN.
// Source: skating ratio as in GMD (Karunratanakul et al. 2023); foot motion as in MANN.
struct FootSlide {
  // Of the steps from frame to frame with a foot on the floor at both ends, the share that is
  // faster than 0.5 m/s. 0 to 1.
  double skating_ratio = 0;
  // Mean movement in such a step. Unit: centimetres a frame; depends on the frame rate.
  double centimetres_a_frame = 0;
};
FootSlide MeasureFootSlide(const std::vector<motion::Vec3>& positions,
                           const motion::Skeleton& skeleton, double frame_rate_hz);

}  // namespace duet::evaluation::metrics

#endif  // DUET_MODEL_EVALUATION_METRICS_MOTION_QUALITY_H_
