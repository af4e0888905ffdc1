#include "model/motion/filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace duet::motion {
namespace {

// One joint that is at `x` frame after frame.
Poses Along(const std::vector<float>& x) {
  Poses poses(static_cast<int>(x.size()), 1);
  for (size_t t = 0; t < x.size(); ++t) poses.at(static_cast<int>(t), 0) = {x[t], 1, -x[t]};
  return poses;
}

TEST(GaussianFilterTest, SteadyMotionStays) {
  const Poses steady = Along({0, 2, 4, 6, 8, 10, 12, 14, 16, 18});
  const Poses smooth = GaussianFilter(steady, 1);
  for (int t = 0; t < 10; ++t) {
    EXPECT_NEAR(smooth.at(t, 0).x, steady.at(t, 0).x, 1e-5) << t;
    EXPECT_NEAR(smooth.at(t, 0).y, 1, 1e-6) << t;
  }
}

TEST(GaussianFilterTest, ImpulseBecomesTheKernel) {
  const Poses smooth = GaussianFilter(Along({0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0}), 1);
  double sum = 0;
  for (int i = -3; i <= 3; ++i) sum += std::exp(-0.5 * i * i);
  for (int t = 0; t < 11; ++t) {
    const int i = t - 5;
    EXPECT_NEAR(smooth.at(t, 0).x, std::abs(i) > 3 ? 0 : std::exp(-0.5 * i * i) / sum, 1e-6) << t;
  }
}

TEST(GaussianFilterTest, EndsStayWhereTheyAre) {
  const Poses smooth = GaussianFilter(Along({3, 4, 1, 7, 2, 9}), 1.5);
  EXPECT_NEAR(smooth.at(0, 0).x, 3, 1e-5);
  EXPECT_NEAR(smooth.at(5, 0).x, 9, 1e-5);
}

TEST(GaussianFilterTest, ClipShorterThanTheKernelIsSmoothed) {
  const Poses smooth = GaussianFilter(Along({0, 1}), 2);
  ASSERT_EQ(smooth.frame_count(), 2);
  EXPECT_NEAR(smooth.at(0, 0).x, 0, 1e-6);
  EXPECT_NEAR(smooth.at(1, 0).x, 1, 1e-6);
  EXPECT_EQ(GaussianFilter(Along({5}), 2), Along({5}));
}

TEST(GaussianFilterTest, ZeroWidthChangesNothing) {
  const Poses poses = Along({0, 5, 1});
  EXPECT_EQ(GaussianFilter(poses, 0), poses);
  EXPECT_EQ(GaussianFilter(poses, -1), poses);
}

TEST(WithoutNoiseTest, FiltersTheSameTimeAtEveryRate) {
  // A jump of 1 m in the middle of 2 s: what is left of it 0.1 s before, at 15 and at 60 Hz.
  for (const int rate : {15, 60}) {
    Poses jump(2 * rate, 1);
    for (int t = rate; t < 2 * rate; ++t) jump.at(t, 0) = {1, 0, 0};
    const float before = WithoutNoise(jump, rate).at(rate - rate / 5, 0).x;
    EXPECT_NEAR(before, 0.03, 0.02) << rate;
    EXPECT_GT(before, 0.005) << rate;
  }
}

TEST(RepairJumpsTest, SpikeTakesItsNeighboursPlace) {
  Poses poses = Along({0, 0.01f, 0.02f, 0.8f, 0.04f, 0.05f, 0.06f});
  EXPECT_EQ(RepairJumps(&poses), 1);
  EXPECT_NEAR(poses.at(3, 0).x, 0.03, 1e-6);
  EXPECT_FLOAT_EQ(poses.at(2, 0).x, 0.02f);
  EXPECT_FLOAT_EQ(poses.at(4, 0).x, 0.04f);
}

TEST(RepairJumpsTest, SpikesAtTheEndsAreRepaired) {
  Poses poses = Along({1, 0, 0, 0, 0, 0, -1});
  EXPECT_EQ(RepairJumps(&poses), 2);
  EXPECT_EQ(poses, Along({0, 0, 0, 0, 0, 0, 0}));
}

TEST(RepairJumpsTest, FastPunchStays) {
  const Poses punch = Along({0, 0.02f, 0.2f, 0.6f, 0.25f, 0.05f, 0});
  Poses poses = punch;
  EXPECT_EQ(RepairJumps(&poses), 0);
  EXPECT_EQ(poses, punch);
}

TEST(RepairJumpsTest, StepThatStaysIsNoJump) {
  const Poses step = Along({0, 0, 0, 1, 1, 1});
  Poses poses = step;
  EXPECT_EQ(RepairJumps(&poses), 0);
  EXPECT_EQ(poses, step);
}

TEST(RepairJumpsTest, JitterOfCentimetresStays) {
  Poses poses = Along({0, 0, 0, 0.06f, 0, 0, 0});
  EXPECT_EQ(RepairJumps(&poses), 0);
}

TEST(RepairJumpsTest, TwoFramesStay) {
  Poses poses = Along({0, 5});
  EXPECT_EQ(RepairJumps(&poses), 0);
  EXPECT_EQ(poses, Along({0, 5}));
}

}  // namespace
}  // namespace duet::motion
