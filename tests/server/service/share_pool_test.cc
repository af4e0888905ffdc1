#include "server/service/share_pool.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace duet::server::service {
namespace {

// Takes one at a time until refused; what was taken.
std::vector<ShareLease> TakeAll(SharePool& pool, const std::string& client) {
  std::vector<ShareLease> taken;
  while (std::optional<ShareLease> lease = pool.Take(client)) taken.push_back(*std::move(lease));
  return taken;
}

TEST(SharePoolTest, LeaseReleasesOnceWhenMoved) {
  SharePool pool(4, 1);
  {
    ShareLease first = *pool.Take("a", 3);
    ShareLease second = std::move(first);
    ShareLease third;
    third = std::move(second);
    EXPECT_TRUE(third);
    EXPECT_EQ(pool.taken(), 3u);
  }
  EXPECT_EQ(pool.taken(), 0u);
}

TEST(SharePoolTest, AloneAClientComesToHoldItsShare) {
  SharePool pool(128, 0.75);
  const std::vector<ShareLease> greedy = TakeAll(pool, "greedy");
  EXPECT_EQ(greedy.size(), 96u);
}

TEST(SharePoolTest, TwoGreedyClientsGetEqualSharesAndLeaveSomeFree) {
  SharePool pool(70, 0.75);
  std::vector<ShareLease> a, b;
  for (bool any = true; any;) {
    any = false;
    if (auto lease = pool.Take("a")) a.push_back(*std::move(lease)), any = true;
    if (auto lease = pool.Take("b")) b.push_back(*std::move(lease)), any = true;
  }
  EXPECT_EQ(a.size(), 30u);  // 3/7
  EXPECT_EQ(b.size(), 30u);
}

TEST(SharePoolTest, AmountsCount) {
  SharePool pool(100, 0.5);
  const std::optional<ShareLease> large = pool.Take("a", 60);
  EXPECT_TRUE(large.has_value()) << "a client that holds nothing may take what is free";
  EXPECT_FALSE(pool.Take("a", 1).has_value());
  EXPECT_FALSE(pool.Take("b", 41).has_value());
  EXPECT_TRUE(pool.Take("b", 40).has_value());
}

// An empty message holds zero bytes. Two of them at a time once left the map with an erased entry,
// whose second erasure corrupted it under the lock.
TEST(SharePoolTest, LeasesOfZeroLeaveNothingBehind) {
  SharePool pool(8, 0.5);
  {
    const std::optional<ShareLease> first = pool.Take("a", 0);
    const std::optional<ShareLease> second = pool.Take("a", 0);
    const std::optional<ShareLease> some = pool.Take("a", 3);
    ASSERT_TRUE(first.has_value());
    ASSERT_TRUE(second.has_value());
    ASSERT_TRUE(some.has_value());
    EXPECT_EQ(pool.taken(), 3u);
  }
  EXPECT_EQ(pool.taken(), 0u);
  EXPECT_TRUE(pool.Take("a", 8).has_value()) << "the client's account was not cleared";
}

// Under ThreadSanitizer (label "threads") this also shows that the pool is locked throughout.
TEST(SharePoolTest, ManyThreadsLeaveNothingBehind) {
  constexpr int kThreads = 4, kRounds = 2000;
  SharePool pool(1000, 1);
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&pool, i] {
      for (int round = 0; round < kRounds; ++round) {
        const std::string client = round % 2 == 0 ? "shared" : std::to_string(i);
        const std::optional<ShareLease> nothing = pool.Take(client, 0);
        const std::optional<ShareLease> some = pool.Take(client, static_cast<std::size_t>(i));
        EXPECT_TRUE(nothing.has_value());
        EXPECT_TRUE(some.has_value());
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(pool.taken(), 0u);
}

}  // namespace
}  // namespace duet::server::service
