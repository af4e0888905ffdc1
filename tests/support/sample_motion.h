#ifndef DUET_TESTS_SUPPORT_SAMPLE_MOTION_H_
#define DUET_TESTS_SUPPORT_SAMPLE_MOTION_H_

#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::test {

// A smooth made-up pose of the SBU skeleton at a time: a person of plausible size who walks slowly,
// turns and swings the limbs. The same at every frame rate.
// Shapes: [15]. Units: metres, y up.
std::vector<motion::Vec3> SwayingPose(double seconds);

// The same as a motion from time 0. Shapes: [frames, 15].
motion::Poses SwayingMotion(int frames, double frame_rate_hz);

}  // namespace duet::test

#endif  // DUET_TESTS_SUPPORT_SAMPLE_MOTION_H_
