#include "client/batch/flow/call_gate.h"

#include <atomic>
#include <thread>
#include <vector>

#include "client/batch/flow/queues.h"
#include "gtest/gtest.h"

namespace duet::client::batch::flow {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;

TEST(CallGate, NeverStartsMoreCallsThanTheWindow) {
  Options options;
  options.max_in_flight = 3;
  CallGate gate(options, hours(1));
  std::atomic<int> under_way{0}, most{0}, made{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&] {
      for (int n = 0; n < 50; ++n) {
        const auto call = gate.Start();
        const int now = ++under_way;
        for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {
        }
        ++made;
        --under_way;
        gate.Finish(*call, CallEnd::kAnswered, std::nullopt);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(made, 400);
  EXPECT_LE(most, 3);
}

TEST(CallGate, StopWakesWaitingThreads) {
  CallGate gate(Options(), hours(1));
  while (gate.state().in_flight < gate.state().limit) gate.Start();
  std::thread waiting([&gate] { EXPECT_FALSE(gate.Start().has_value()); });
  gate.Stop();
  waiting.join();
}

TEST(CallGate, EndsIfServersStayAway) {
  Options options;
  options.first_backoff = options.longest_backoff = milliseconds(1);
  CallGate gate(options, milliseconds(0));
  gate.Finish(*gate.Start(), CallEnd::kAway, std::nullopt);
  EXPECT_FALSE(gate.state().lost_patience);
  gate.Finish(*gate.Start(), CallEnd::kAway, std::nullopt);
  EXPECT_TRUE(gate.state().lost_patience);
  EXPECT_FALSE(gate.Start().has_value());
}

TEST(BoundedQueue, EveryValueIsTakenOnce) {
  BoundedQueue<int> queue(2);
  std::atomic<int> sum{0};
  std::vector<std::thread> takers;
  for (int i = 0; i < 3; ++i) {
    takers.emplace_back([&] {
      while (const auto value = queue.Take()) sum += *value;
    });
  }
  for (int i = 1; i <= 100; ++i) EXPECT_TRUE(queue.Put(i));
  queue.Close();
  for (std::thread& taker : takers) taker.join();
  EXPECT_EQ(sum, 5050);
}

TEST(BoundedQueue, PutBlocksWhileFullUntilStop) {
  BoundedQueue<int> queue(1);
  EXPECT_TRUE(queue.Put(1));
  std::thread putting([&queue] { EXPECT_FALSE(queue.Put(2)); });
  queue.Stop();
  putting.join();
  EXPECT_FALSE(queue.Take().has_value());
}

TEST(BoundedQueue, GatherReturnsEarlyWhenFull) {
  BoundedQueue<int> queue(4);
  for (int i = 0; i < 3; ++i) queue.Put(i);
  // More than half full: there is nothing to wait for.
  EXPECT_EQ(queue.Gather(hours(1)), (std::vector<int>{0, 1, 2}));
  queue.Put(3);
  EXPECT_EQ(queue.Gather(milliseconds(0)), (std::vector<int>{3}));
  std::thread late([&queue] {
    queue.Put(4);
    queue.Put(5);
    queue.Close();
  });
  EXPECT_EQ(queue.Gather(hours(1)), (std::vector<int>{4, 5}));
  late.join();
  EXPECT_TRUE(queue.Gather(hours(1)).empty());
}

TEST(BoundedQueue, CapacityLimitsTheTotalCost) {
  BoundedQueue<int> queue(10);
  queue.Put(1, 100);  // more than there is room for: alone
  std::atomic<bool> put{false};
  std::thread putting([&] {
    queue.Put(2, 6);
    queue.Put(3, 6);
    put = true;
  });
  EXPECT_EQ(queue.Take(), 1);
  EXPECT_EQ(queue.Take(), 2);
  EXPECT_EQ(queue.Take(), 3);
  putting.join();
  EXPECT_TRUE(put);
}

}  // namespace
}  // namespace duet::client::batch::flow
