#include <gtest/gtest.h>

#include <chrono>

#include "server/batching/batch_decision.h"

namespace duet::server::batching {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr common::TimePoint kNow(seconds(100));

TEST(CostEstimateTest, IsLinearInFrames) {
  EXPECT_DOUBLE_EQ((CostEstimate{0.5, 0.25}.Seconds(6)), 2.0);
}

TEST(BatchCostTest, IsUnknownAtFirst) {
  EXPECT_EQ(BatchCost().At(kNow).batch_seconds, 0);
  EXPECT_EQ(BatchCost().At(kNow).frame_seconds, 0);
}

TEST(BatchCostTest, IsProportionalToFramesUntilSeveralSizesAreSeen) {
  BatchCost cost;
  for (int i = 0; i < 3; ++i) cost.Observe(40, 0.02, kNow);
  EXPECT_NEAR(cost.At(kNow).batch_seconds, 0, 1e-9);
  EXPECT_NEAR(cost.At(kNow).frame_seconds, 0.0005, 1e-9);
}

// What a model costs that takes 4 ms for a batch and 1 ms for each frame.
double TrueSeconds(int frames) { return 0.004 + 0.001 * frames; }

TEST(BatchCostTest, SeparatesBatchCostFromFrameCostBySeveralSizes) {
  BatchCost cost;
  for (int i = 0; i < 20; ++i) {
    const int frames = 10 + 30 * (i % 5);
    cost.Observe(frames, TrueSeconds(frames), kNow);
  }
  EXPECT_NEAR(cost.At(kNow).batch_seconds, 0.004, 0.001);
  for (const int frames : {10, 46, 130}) {
    EXPECT_NEAR(cost.At(kNow).Seconds(frames), TrueSeconds(frames), 0.05 * TrueSeconds(frames));
  }
}

TEST(BatchCostTest, FollowsAModelThatBecomesSlower) {
  BatchCost cost;
  for (int i = 0; i < 20; ++i) cost.Observe(40, 0.02, kNow);
  for (int i = 0; i < 20; ++i) cost.Observe(40, 0.06, kNow);
  EXPECT_NEAR(cost.At(kNow).Seconds(40), 0.06, 0.002);
}

TEST(BatchCostTest, OutlierCountsAtMostFourTimesTheEstimate) {
  BatchCost cost;
  for (int i = 0; i < 20; ++i) cost.Observe(40, 0.02, kNow);
  BatchCost paused = cost, slow = cost;
  paused.Observe(40, 10, kNow);
  slow.Observe(40, 4 * 0.02, kNow);
  EXPECT_NEAR(paused.At(kNow).Seconds(40), slow.At(kNow).Seconds(40), 1e-9);
  EXPECT_GT(paused.At(kNow).Seconds(40), 0.025);
}

TEST(BatchCostTest, NeitherPartIsEverNegative) {
  BatchCost falling, steep;
  for (int i = 0; i < 5; ++i) {
    falling.Observe(10, 0.02, kNow);
    falling.Observe(100, 0.01, kNow);
    steep.Observe(10, 0.001, kNow);
    steep.Observe(100, 0.1, kNow);
  }
  EXPECT_EQ(falling.At(kNow).frame_seconds, 0);
  EXPECT_GT(falling.At(kNow).batch_seconds, 0);
  EXPECT_NEAR(steep.At(kNow).batch_seconds, 0, 1e-9);
  EXPECT_GT(steep.At(kNow).frame_seconds, 0);
}

TEST(BatchCostTest, HalvesEachSecondWithoutABatch) {
  BatchCost cost;
  cost.Observe(40, 0.02, kNow);
  EXPECT_NEAR(cost.At(kNow).Seconds(40), 0.02, 1e-9);
  EXPECT_NEAR(cost.At(kNow + seconds(1)).Seconds(40), 0.01, 1e-9);
  EXPECT_NEAR(cost.At(kNow + seconds(3)).Seconds(40), 0.0025, 1e-9);
  EXPECT_NEAR(cost.At(kNow - milliseconds(5)).Seconds(40), 0.02, 1e-9);
  cost.Observe(40, 0.02, kNow + seconds(3));
  EXPECT_NEAR(cost.At(kNow + seconds(3)).Seconds(40), 0.02, 1e-9);
}

}  // namespace
}  // namespace duet::server::batching
