#include "tests/solver/noisy_person.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/authoring/made_leaders.h"
#include "model/base/random.h"
#include "model/body/limbs.h"
#include "model/motion/skeleton.h"

namespace duet::solver {

using motion::Poses;
using motion::Vec3;

Poses WalkingPerson(double seconds) { return authoring::MakeLeader("walk_eight", seconds, kRate); }

Poses WithCameraNoise(Poses person) {
  constexpr double kDeviation = 0.02;  // metres
  constexpr float kLasting = 0.6f;     // share of the error that the next frame has too
  base::Random random(7);
  std::vector<Vec3> errors(static_cast<std::size_t>(person.joint_count()));
  for (int t = 0; t < person.frame_count(); ++t) {
    for (int joint = 0; joint < person.joint_count(); ++joint) {
      Vec3& error = errors[static_cast<std::size_t>(joint)];
      const auto draw = [&] { return static_cast<float>(random.Normal(kDeviation)); };
      error = error * kLasting + Vec3{draw(), draw(), draw()} * std::sqrt(1 - kLasting * kLasting);
      person.at(t, joint) += error;
    }
  }
  return person;
}

double KneeDegrees(const Poses& person) {
  double sum = 0;
  for (int t = 0; t < person.frame_count(); ++t) {
    for (const body::Limb& leg : body::FindBody(motion::SbuSkeleton()).legs) {
      const Vec3 thigh = person.at(t, leg.middle) - person.at(t, leg.upper);
      const Vec3 shin = person.at(t, leg.end) - person.at(t, leg.middle);
      sum += std::acos(std::clamp(Dot(thigh, shin) / (Norm(thigh) * Norm(shin)), -1.0f, 1.0f));
    }
  }
  return sum / (2 * person.frame_count()) * 180 / 3.14159265;
}

double MeanDistance(const Poses& a, const Poses& b) {
  double sum = 0;
  for (int t = 0; t < a.frame_count(); ++t) {
    for (int joint = 0; joint < a.joint_count(); ++joint) {
      sum += Distance(a.at(t, joint), b.at(t, joint));
    }
  }
  return sum / (a.frame_count() * a.joint_count());
}

double SlowerFoot(const Poses& person) {
  const motion::JointPair feet = *motion::SbuSkeleton().feet;
  double sum = 0;
  for (int t = 1; t < person.frame_count(); ++t) {
    sum += std::min(Distance(person.at(t, feet.left), person.at(t - 1, feet.left)),
                    Distance(person.at(t, feet.right), person.at(t - 1, feet.right)));
  }
  return sum / (person.frame_count() - 1);
}

}  // namespace duet::solver
