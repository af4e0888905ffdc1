#ifndef DUET_MODEL_BODY_LIVELINESS_H_
#define DUET_MODEL_BODY_LIVELINESS_H_

#include "model/motion/poses.h"

// How much a body moves. Sensor noise adds apparent movement (a quarter of the 0.51 m/s in SBU), so
// captured and synthesised motion are compared after the same filter (motion::WithoutNoise).
//
// Units: poses in world metres.

namespace duet::body {

// The mean speed of the joints, m/s. 0 for one frame.
double JointSpeed(const motion::Poses& poses, double frame_rate_hz);

// The mean over frames and joints of | v^ - v |, v the difference of successive frames, m/s.
// Shapes: predicted and truth are alike, of two frames or more.
double VelocityError(const motion::Poses& predicted, const motion::Poses& truth,
                     double frame_rate_hz);

// The mean over the joints of the largest distance from the joint's position in frame 0, metres.
double RangeOfMotion(const motion::Poses& poses);

}  // namespace duet::body

#endif  // DUET_MODEL_BODY_LIVELINESS_H_
