#ifndef DUET_TESTS_SUPPORT_SAMPLE_MOTION_H_
#define DUET_TESTS_SUPPORT_SAMPLE_MOTION_H_

#include <vector>

#include "model/motion/clip.h"
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

// The same as a clip.
motion::Clip SwayingClip(int frames, double frame_rate_hz);

// A person of the SBU skeleton who stands, and steps forward with the left and the right foot in
// turn: each step takes 0.3 s at 1 m/s, and ends at one of the ascending times `steps`, seconds.
// Shapes: [frames, 15].
motion::Poses SteppingMotion(const std::vector<double>& steps, int frames, double frame_rate_hz);

}  // namespace duet::test

#endif  // DUET_TESTS_SUPPORT_SAMPLE_MOTION_H_
