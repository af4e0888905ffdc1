#include <gtest/gtest.h>

#include "server/batching/batch_decision.h"

namespace duet::server::batching {
namespace {

constexpr CostEstimate kUnknown;
constexpr CostEstimate kCost = {1, 1};  // a batch of n frames takes n + 1 s

TEST(EvenShareTest, FreeWorkersGetEqualSharesWithUnknownCost) {
  EXPECT_EQ(EvenShare(8, 2, {}, kUnknown), 4);
  EXPECT_EQ(EvenShare(9, 2, {}, kUnknown), 5);
  EXPECT_EQ(EvenShare(8, 1, {3}, kUnknown), 8);
  EXPECT_EQ(EvenShare(1, 4, {}, kUnknown), 1);
}

TEST(EvenShareTest, FreeWorkersGetEqualSharesWithKnownCost) {
  EXPECT_EQ(EvenShare(8, 1, {}, kCost), 8);
  EXPECT_EQ(EvenShare(8, 2, {}, kCost), 4);
  EXPECT_EQ(EvenShare(9, 3, {}, kCost), 3);
  EXPECT_EQ(EvenShare(10, 3, {}, kCost), 4);
}

TEST(EvenShareTest, BusyWorkerGetsWhatItHasTimeFor) {
  // The other is free at once, after 2 s, after 4 s: both end at 5, 6, 7 s.
  EXPECT_EQ(EvenShare(8, 1, {0}, kCost), 4);
  EXPECT_EQ(EvenShare(8, 1, {2}, kCost), 5);
  EXPECT_EQ(EvenShare(8, 1, {4}, kCost), 6);
}

TEST(EvenShareTest, TakesAllWithoutOtherWorkers) {
  // Alone it ends at 9 s; the other could not have ended even one window by then.
  EXPECT_EQ(EvenShare(8, 1, {8}, kCost), 8);
  EXPECT_EQ(EvenShare(8, 1, {100}, kCost), 8);
}

TEST(EvenShareTest, CountsEveryWorkerThatIsFreeInTimeInAnyOrder) {
  // (8 + 1 + 1 + 2 + 1 + 3) / 3 = 16 / 3 s: 4.33 frames of its own.
  EXPECT_EQ(EvenShare(8, 1, {3, 50, 2}, kCost), 5);
}

TEST(EvenShareTest, TakesAtLeastOne) { EXPECT_EQ(EvenShare(1, 1, {0, 0, 0}, kCost), 1); }

TEST(EvenShareTest, ConstantCostBatchesAreSplitAmongFreeWorkers) {
  EXPECT_EQ(EvenShare(8, 2, {}, {1, 0}), 4);
}

}  // namespace
}  // namespace duet::server::batching
