#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "server/metrics/log_sink.h"

namespace duet::server::metrics {
namespace {

constexpr int kFull = 8;  // RESOURCE_EXHAUSTED
constexpr int kWho = 16;  // UNAUTHENTICATED

TEST(CallLogFilterTest, LogsTheFirstRejectionsOfASecondAndCountsTheRest) {
  CallLogFilter filter(2);
  EXPECT_TRUE(filter.LogRefusal(kFull, 100.0));
  EXPECT_TRUE(filter.LogRefusal(kFull, 100.5));
  EXPECT_FALSE(filter.LogRefusal(kFull, 100.6));
  EXPECT_FALSE(filter.LogRefusal(kFull, 100.9));
  EXPECT_TRUE(filter.LogRefusal(kFull, 101.0));
  const std::vector<CallLogFilter::Unlogged> unlogged = filter.TakeUnlogged();
  ASSERT_EQ(unlogged.size(), 1u);
  EXPECT_EQ(unlogged[0].code, kFull);
  EXPECT_EQ(unlogged[0].calls, 2u);
  EXPECT_TRUE(filter.TakeUnlogged().empty());
}

TEST(CallLogFilterTest, LimitsEachCodeSeparately) {
  CallLogFilter filter(1);
  for (int i = 0; i < 100; ++i) filter.LogRefusal(kFull, 5);
  EXPECT_TRUE(filter.LogRefusal(kWho, 5));
}

TEST(CallLogFilterTest, LogsAfterTheClockIsSetBack) {
  CallLogFilter filter(1);
  EXPECT_TRUE(filter.LogRefusal(kFull, 5000));
  EXPECT_TRUE(filter.LogRefusal(kFull, 10));
}

TEST(CallLogFilterTest, EveryCallIsLoggedOrCounted) {
  CallLogFilter filter(10);
  std::atomic<int> logged{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 500; ++i) logged += filter.LogRefusal(kFull, 7) ? 1 : 0;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(logged.load(), 10);
  EXPECT_EQ(filter.TakeUnlogged().at(0).calls, 1990u);
}

}  // namespace
}  // namespace duet::server::metrics
