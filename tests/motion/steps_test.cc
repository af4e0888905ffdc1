#include "model/motion/steps.h"

#include <cmath>

#include "gmock/gmock.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"

namespace duet::motion {
namespace {

using test::SteppingMotion;

JointPair Feet() { return *SbuSkeleton().feet; }

TEST(FindStepsTest, FindsWhereEachFootComesToRest) {
  for (const double rate : {24.0, 30.0, 60.0}) {
    const int frames = static_cast<int>(4 * rate);
    const std::vector<double> steps =
        FindSteps(Feet(), SteppingMotion({1, 1.5, 2.25}, frames, rate), rate);
    ASSERT_THAT(steps, SizeIs(3)) << rate;
    // With the filter, the foot seems to rest a little later.
    EXPECT_NEAR(steps[0], 1.08, 0.06) << rate;
    EXPECT_NEAR(steps[1] - steps[0], 0.5, 1 / rate + 1e-6) << rate;
    EXPECT_NEAR(steps[2] - steps[1], 0.75, 1 / rate + 1e-6) << rate;
  }
}

TEST(FindStepsTest, StandingPersonHasNone) {
  EXPECT_THAT(FindSteps(Feet(), SteppingMotion({}, 60, 30), 30), IsEmpty());
  EXPECT_THAT(FindSteps(Feet(), SteppingMotion({}, 1, 30), 30), IsEmpty());
  EXPECT_THAT(FindSteps(Feet(), Poses(0, 15), 30), IsEmpty());
}

TEST(MeasureStepTimingTest, MeasuresDistancesFromTheNearestTime) {
  const StepTiming timing = MeasureStepTiming({0.9, 2.1, 3.4}, {1, 2, 3, 4});
  EXPECT_EQ(timing.steps, 3);
  EXPECT_NEAR(timing.mean_distance, 0.2, 1e-9);
  // Of 0.1, -0.1 and -0.4.
  EXPECT_NEAR(timing.spread, std::sqrt((0.0544444 + 0.0011111 + 0.0711111) / 2), 1e-6);
}

TEST(MeasureStepTimingTest, ConstantDelayHasNoSpread) {
  const StepTiming timing = MeasureStepTiming({1.1, 2.1, 3.1}, {1, 2, 3});
  EXPECT_NEAR(timing.mean_distance, 0.1, 1e-9);
  EXPECT_NEAR(timing.spread, 0, 1e-9);
}

TEST(MeasureStepTimingTest, FarStepsAreOnlyCounted) {
  const StepTiming timing = MeasureStepTiming({1.1, 2.1, 9, 30}, {1, 2, 3}, 0.5);
  EXPECT_EQ(timing.steps, 2);
  EXPECT_EQ(timing.far, 2);
  EXPECT_NEAR(timing.spread, 0, 1e-9);
  EXPECT_NEAR(timing.mean_distance, 0.1, 1e-9);
}

TEST(MeasureStepTimingTest, StepsBeyondTheEndsHaveADistanceToo) {
  EXPECT_NEAR(MeasureStepTiming({0, 5}, {1, 3}).mean_distance, 1.5, 1e-9);
}

TEST(MeasureStepTimingTest, TooFewStepsOrNoTimesHaveNoFigures) {
  EXPECT_TRUE(std::isnan(MeasureStepTiming({}, {1}).mean_distance));
  EXPECT_EQ(MeasureStepTiming({}, {1}).steps, 0);
  EXPECT_TRUE(std::isnan(MeasureStepTiming({1}, {1}).spread));
  EXPECT_TRUE(std::isnan(MeasureStepTiming({1, 2}, {}).mean_distance));
}

}  // namespace
}  // namespace duet::motion
