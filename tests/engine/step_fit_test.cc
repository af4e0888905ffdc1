#include "model/engine/step_fit.h"

#include <cmath>

#include "gmock/gmock.h"
#include "tests/cleanup/bodies.h"

namespace duet::engine {
namespace {

using authoring::PuppetPose;
using cleanup::kAnkle;
using cleanup::kRate;
using cleanup::Puppet;

// Steps on the spot at times that `when` bends: from seconds to the phase of the steps, in steps.
template <typename When>
motion::Poses Stepping(double seconds, const When& when) {
  return Puppet(
      [&](double at, PuppetPose* pose) {
        const auto lift = [&](double phase) {
          return 0.25 * std::max(0.0, std::sin(2 * 3.14159265 * (when(at) + phase)));
        };
        pose->left_foot.target.y = kAnkle + lift(0);
        pose->right_foot.target.y = kAnkle + lift(0.5);
      },
      static_cast<int>(seconds * kRate));
}

// An uneven rhythm, so that its steps at another time do not fall on each other.
double Rhythm(double at) { return 0.7 * at + 0.6 * std::sin(0.9 * at) + 0.3 * std::sin(2.3 * at); }

bool InTime(double seconds, double (*when)(double), int pairs = 4) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  StepFit fit(skeleton, kRate);
  const motion::Poses leader = Stepping(seconds, Rhythm), follower = Stepping(seconds, when);
  for (int i = 0; i < pairs; ++i) fit.Add(leader, follower);
  return fit.InTime();
}

TEST(StepFit, PeopleWhoStepTogetherAreInTime) {
  EXPECT_TRUE(InTime(60, Rhythm));
  EXPECT_TRUE(InTime(60, [](double at) { return Rhythm(at - 0.1); }));
}

TEST(StepFit, PeopleWithARhythmOfTheirOwnAreNot) {
  EXPECT_FALSE(InTime(60, [](double at) { return 0.93 * at; }));
}

TEST(StepFit, ShortClipsAndFewStepsDecideNothing) {
  EXPECT_FALSE(InTime(9, Rhythm, 100));
  EXPECT_FALSE(InTime(20, Rhythm, 1));
}

TEST(StepFit, NeedsFeet) {
  motion::Skeleton skeleton = motion::SbuSkeleton();
  skeleton.feet.reset();
  StepFit fit(skeleton, kRate);
  for (int i = 0; i < 4; ++i) fit.Add(Stepping(60, Rhythm), Stepping(60, Rhythm));
  EXPECT_FALSE(fit.InTime());
}

}  // namespace
}  // namespace duet::engine
