#ifndef DUET_TESTS_SOLVER_NOISY_PERSON_H_
#define DUET_TESTS_SOLVER_NOISY_PERSON_H_

#include "model/motion/poses.h"

namespace duet::solver {

// The rate of SBU's captures.
inline constexpr double kRate = 15;

// A person of SbuSkeleton's joints who walks a figure of eight: bones of one length, standing feet
// that do not move.
motion::Poses WalkingPerson(double seconds);

// The same person as a depth camera captures it: every joint is off by a few centimetres, which
// last for a few frames.
motion::Poses WithCameraNoise(motion::Poses person);

// The mean bend of both knees, degrees.
double KneeDegrees(const motion::Poses& person);

// The mean distance of the joints of two motions, metres. Requires as many frames in both.
double MeanDistance(const motion::Poses& a, const motion::Poses& b);

// The mean way in a frame of the foot that moves less, metres.
double SlowerFoot(const motion::Poses& person);

}  // namespace duet::solver

#endif  // DUET_TESTS_SOLVER_NOISY_PERSON_H_
