#ifndef DUET_MODEL_BODY_MOTION_QUALITY_H_
#define DUET_MODEL_BODY_MOTION_QUALITY_H_

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// Figures of a single motion. Captured motion has errors too (bone lengths from Kinect vary by a
// tenth): compare each figure with that of the captured follower.
//
// Units: poses in world metres, y up.

namespace duet::body {

// The mean over bones of (standard deviation over time) / (mean over time) of the bone's length. 0
// for bones of constant length. Dimensionless. Bones of mean length 0 count as 0.
double BoneLengthDrift(const motion::Poses& poses, const motion::Skeleton& skeleton);

// The mean over joints and frames of the norm of the third difference, times rate^3. Unit: m/s^3.
// 0 for fewer than four frames.
double Jitter(const motion::Poses& poses, double frame_rate_hz);

// How far feet slide while they are on the floor. A step is a foot's movement along the floor from
// one frame to the next; it counts if the foot is on the floor in both frames: at most 5 cm above
// the lowest point that either foot reaches in the whole motion. NaN for a skeleton without feet.
// Source: skating ratio as in GMD (Karunratanakul et al. 2023); foot motion as in MANN.
struct FootSlide {
  // The share of the steps that are faster than 0.5 m/s. 0 to 1.
  double skating_ratio = 0;
  // The mean length of a step. Unit: centimetres per frame; depends on the frame rate.
  double centimetres_a_frame = 0;
};
FootSlide MeasureFootSlide(const motion::Poses& poses, const motion::Skeleton& skeleton,
                           double frame_rate_hz);

}  // namespace duet::body

#endif  // DUET_MODEL_BODY_MOTION_QUALITY_H_
