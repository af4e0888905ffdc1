#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "server/security/access_control.h"
#include "tests/server/support/fake_clock.h"

namespace duet::server::security {
namespace {

using std::chrono::milliseconds;
using test::FakeClock;

TEST(CallerUsageTest, AllowsABurstOfOneSecondsCalls) {
  FakeClock clock;
  CallerUsage usage;
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(usage.TakeCall(5, clock.Now()).has_value()) << i;
  EXPECT_TRUE(usage.TakeCall(5, clock.Now()).has_value());
}

TEST(CallerUsageTest, RejectedCallGetsARetryDelay) {
  FakeClock clock;
  CallerUsage usage;
  for (int i = 0; i < 4; ++i) usage.TakeCall(4, clock.Now());
  EXPECT_DOUBLE_EQ(usage.TakeCall(4, clock.Now()).value(), 0.25);
  clock.Advance(milliseconds(100));
  EXPECT_NEAR(usage.TakeCall(4, clock.Now()).value(), 0.15, 1e-9);
  clock.Advance(milliseconds(150));
  EXPECT_FALSE(usage.TakeCall(4, clock.Now()).has_value());
  EXPECT_TRUE(usage.TakeCall(4, clock.Now()).has_value());
}

TEST(CallerUsageTest, PauseSavesAtMostOneSecondsCalls) {
  FakeClock clock;
  CallerUsage usage;
  usage.TakeCall(3, clock.Now());
  clock.Advance(milliseconds(3'600'000));
  int taken = 0;
  while (taken < 100 && !usage.TakeCall(3, clock.Now()).has_value()) ++taken;
  EXPECT_EQ(taken, 3);
}

TEST(CallerUsageTest, OlderTimeAddsNoCalls) {
  FakeClock clock;
  const common::TimePoint early = clock.Now();
  clock.Advance(milliseconds(1000));
  CallerUsage usage;
  for (int i = 0; i < 2; ++i) EXPECT_FALSE(usage.TakeCall(2, clock.Now()).has_value());
  EXPECT_TRUE(usage.TakeCall(2, early).has_value());
  EXPECT_TRUE(usage.TakeCall(2, clock.Now()).has_value());
}

TEST(CallerUsageTest, HoldsFramesUpToTheLimit) {
  const auto usage = std::make_shared<CallerUsage>();
  ASSERT_TRUE(usage->TakeFrames(60, 100));
  FrameLease lease(usage, 60);
  EXPECT_FALSE(usage->TakeFrames(41, 100));
  EXPECT_TRUE(usage->TakeFrames(40, 100));
  lease = FrameLease();
  EXPECT_EQ(usage->frames(), 40);
}

TEST(CallerUsageTest, MovedLeaseReturnsItsFramesOnce) {
  const auto usage = std::make_shared<CallerUsage>();
  ASSERT_TRUE(usage->TakeFrames(60, 100));
  {
    FrameLease first(usage, 60);
    const FrameLease second(std::move(first));
    EXPECT_EQ(usage->frames(), 60);
  }
  EXPECT_EQ(usage->frames(), 0);
}

TEST(CallerUsageTest, ConcurrentCallsDoNotExceedTheLimit) {
  FakeClock clock;
  const auto usage = std::make_shared<CallerUsage>();
  std::atomic<int> calls{0};
  std::atomic<int> leases{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 200; ++i) {
        if (!usage->TakeCall(100, clock.Now()).has_value()) ++calls;
        if (usage->TakeFrames(7, 70)) {
          const FrameLease lease(usage, 7);
          ++leases;
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(calls.load(), 100);
  EXPECT_EQ(leases.load(), 800);
  EXPECT_EQ(usage->frames(), 0);
}

}  // namespace
}  // namespace duet::server::security
