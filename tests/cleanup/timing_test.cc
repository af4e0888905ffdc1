#include "model/cleanup/timing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "gtest/gtest.h"
#include "model/cleanup/low_pass.h"

namespace duet::cleanup {
namespace {

TEST(EaseIn, RisesFromZeroToOneWithinAThirdOfASecond) {
  const Timing timing{15, 4};
  EXPECT_EQ(EaseIn(timing, 0), 0);
  EXPECT_EQ(EaseIn(timing, 3), 0);
  for (int t = 4; t < 9; ++t) EXPECT_GT(EaseIn(timing, t), EaseIn(timing, t - 1)) << t;
  EXPECT_LT(EaseIn(timing, 8), 1);
  EXPECT_EQ(EaseIn(timing, 9), 1);
  EXPECT_EQ(EaseIn(timing, 40), 1);
}

TEST(EaseIn, TakesAsLongAtEveryRate) {
  EXPECT_LT(EaseIn({60, 10}, 10 + 19), 1);
  EXPECT_EQ(EaseIn({60, 10}, 10 + 20), 1);
}

TEST(EaseIn, IsOneWithoutSettledFrames) { EXPECT_EQ(EaseIn({15, 0}, 0), 1); }

TEST(SoftLimit, KeepsSmallValuesAndLimitsLargeOnes) {
  EXPECT_EQ(SoftLimit(0, 12, 14), 0);
  EXPECT_EQ(SoftLimit(12, 12, 14), 12);
  EXPECT_NEAR(SoftLimit(12.01f, 12, 14), 12.01f, 1e-4f);
  EXPECT_GT(SoftLimit(14, 12, 14), 13);
  EXPECT_LE(SoftLimit(90, 12, 14), 14);
}

TEST(LowPass, KeepsAConstantAndRemovesASpike) {
  std::vector<float> track(31, 2);
  for (const float value : LowPass(track, 3)) EXPECT_NEAR(value, 2, 1e-6f);
  track[15] = 10;
  const std::vector<float> smooth = LowPass(track, 3);
  EXPECT_LT(smooth[15], 3.2f);
  EXPECT_NEAR(smooth[15], 2 + 8 / (3 * std::sqrt(2 * 3.14159265f)), 0.01f);
  EXPECT_EQ(smooth[5], 2);  // farther away than three deviations
}

// The mean of frame `t`'s neighbourhood, formed frame by frame as low_pass.h defines it.
motion::Vec3 WeightedMean(const std::vector<motion::Vec3>& track, int t, double sigma) {
  const int last = static_cast<int>(track.size()) - 1,
            reach = static_cast<int>(std::ceil(3 * sigma));
  motion::Vec3 sum;
  float weights = 0;
  for (int u = std::max(0, t - reach); u <= std::min(last, t + reach); ++u) {
    const double away = (u - t) / sigma;
    const float weight = static_cast<float>(std::exp(-0.5 * away * away));
    sum += track[static_cast<std::size_t>(u)] * weight;
    weights += weight;
  }
  return sum / weights;
}

TEST(LowPass, IsTheWeightedMeanOfEachFramesNeighbourhood) {
  for (const int frames : {1, 2, 7, 46}) {
    std::vector<motion::Vec3> track;
    for (int t = 0; t < frames; ++t) {
      const float at = static_cast<float>(t);
      track.push_back({std::sin(at), std::cos(3 * at), 0.1f * at});
    }
    for (const double sigma : {0.3, 1.5, 6.0}) {
      const std::vector<motion::Vec3> smooth = LowPass(track, sigma);
      ASSERT_EQ(smooth.size(), track.size());
      for (int t = 0; t < frames; ++t) {
        EXPECT_LT(Distance(smooth[static_cast<std::size_t>(t)], WeightedMean(track, t, sigma)),
                  1e-5f)
            << frames << " frames, deviation " << sigma << ", frame " << t;
      }
    }
  }
}

TEST(LowPass, LeavesNothingOfNothing) {
  EXPECT_TRUE(LowPass(std::vector<float>{}, 3).empty());
  EXPECT_TRUE(LowPass(std::vector<motion::Vec3>{}, 3).empty());
}

}  // namespace
}  // namespace duet::cleanup
