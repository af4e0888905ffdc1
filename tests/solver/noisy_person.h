#ifndef DUET_TESTS_SOLVER_NOISY_PERSON_H_
#define DUET_TESTS_SOLVER_NOISY_PERSON_H_

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/authoring/made_leaders.h"
#include "model/base/random.h"
#include "model/body/limbs.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::solver {

// The rate of SBU's captures.
inline constexpr double kRate = 15;

// A person of SbuSkeleton's joints who walks a figure of eight: bones of one length, standing feet
// that do not move.
inline motion::Poses WalkingPerson(double seconds) {
  return authoring::MakeLeader("walk_eight", seconds, kRate);
}

// The same person as a depth camera captures it: every joint is off by a few centimetres, which
// last for a few frames.
inline motion::Poses WithCameraNoise(motion::Poses person) {
  constexpr double kDeviation = 0.02;  // metres
  constexpr float kLasting = 0.6f;     // share of the error that the next frame has too
  base::Random random(7);
  std::vector<motion::Vec3> errors(static_cast<std::size_t>(person.joint_count()));
  for (int t = 0; t < person.frame_count(); ++t) {
    for (int joint = 0; joint < person.joint_count(); ++joint) {
      motion::Vec3& error = errors[static_cast<std::size_t>(joint)];
      const auto draw = [&] { return static_cast<float>(random.Normal(kDeviation)); };
      error = error * kLasting +
              motion::Vec3{draw(), draw(), draw()} * std::sqrt(1 - kLasting * kLasting);
      person.at(t, joint) += error;
    }
  }
  return person;
}

// The mean bend of both knees, degrees.
inline double KneeDegrees(const motion::Poses& person) {
  double sum = 0;
  for (int t = 0; t < person.frame_count(); ++t) {
    for (const body::Limb& leg : body::FindBody(motion::SbuSkeleton()).legs) {
      const motion::Vec3 thigh = person.at(t, leg.middle) - person.at(t, leg.upper);
      const motion::Vec3 shin = person.at(t, leg.end) - person.at(t, leg.middle);
      sum += std::acos(std::clamp(Dot(thigh, shin) / (Norm(thigh) * Norm(shin)), -1.0f, 1.0f));
    }
  }
  return sum / (2 * person.frame_count()) * 180 / 3.14159265;
}

// The mean distance of the joints of two motions, metres. Requires as many frames in both.
inline double MeanDistance(const motion::Poses& a, const motion::Poses& b) {
  double sum = 0;
  for (int t = 0; t < a.frame_count(); ++t) {
    for (int joint = 0; joint < a.joint_count(); ++joint) {
      sum += Distance(a.at(t, joint), b.at(t, joint));
    }
  }
  return sum / (a.frame_count() * a.joint_count());
}

// The mean way in a frame of the foot that moves less, metres.
inline double SlowerFoot(const motion::Poses& person) {
  const motion::JointPair feet = *motion::SbuSkeleton().feet;
  double sum = 0;
  for (int t = 1; t < person.frame_count(); ++t) {
    sum += std::min(Distance(person.at(t, feet.left), person.at(t - 1, feet.left)),
                    Distance(person.at(t, feet.right), person.at(t - 1, feet.right)));
  }
  return sum / (person.frame_count() - 1);
}

}  // namespace duet::solver

#endif  // DUET_TESTS_SOLVER_NOISY_PERSON_H_
