#ifndef DUET_TESTS_SUPPORT_TEST_MOTION_H_
#define DUET_TESTS_SUPPORT_TEST_MOTION_H_

#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::test {

// A person made of formulas: facing `yaw` (0 is +z), turning by `turn` over the clip, arms and legs
// swinging, trunk leaning, knees and elbows bending; bones of constant, human length.
struct PersonOptions {
  int frames = 60;
  double yaw = 0;
  double turn = 0;
  motion::Vec3 at = {0, 1.1f, 0};
  double frame_rate_hz = 30;
};
motion::Clip MakePerson(const PersonOptions& options = {});

// The largest distance between the same joints of two clips, metres.
float LargestDistance(const motion::Clip& a, const motion::Clip& b);

}  // namespace duet::test

#endif  // DUET_TESTS_SUPPORT_TEST_MOTION_H_
