#include <atomic>
#include <chrono>
#include <optional>
#include <thread>
#include <vector>

#include "client/batch/flow/queues.h"
#include "gtest/gtest.h"

namespace duet::client::batch::flow {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;

TEST(Queue, ReturnedValuesComeFirst) {
  Queue<int> queue(4);
  queue.Put(1);
  queue.Put(2);
  EXPECT_EQ(queue.Take(), 1);
  queue.PutBack(1);
  EXPECT_EQ(queue.Take(), 1);
  EXPECT_EQ(queue.Take(), 2);
}

TEST(Queue, EndsWhenAllValuesAreDone) {
  Queue<int> queue(4);
  queue.Put(1);
  queue.Close();
  EXPECT_EQ(queue.Take(), 1);
  std::optional<int> second;
  std::thread other([&] {
    second = queue.Take();  // empty, and yet not over
    queue.Done();
  });
  queue.PutBack(1);
  other.join();
  EXPECT_EQ(second, 1);
  EXPECT_FALSE(queue.Take().has_value());
}

TEST(Queue, StopDropsQueuedValuesAndWaitsForTakenOnes) {
  Queue<int> queue(2);
  queue.Put(1);
  queue.Put(2);
  EXPECT_EQ(queue.Take(), 1);
  queue.Stop();
  EXPECT_FALSE(queue.Take().has_value());
  EXPECT_FALSE(queue.Put(3));
  std::atomic<bool> back{false};
  std::thread other([&] {
    back = true;
    queue.PutBack(1);
  });
  queue.WaitUntilNoneIsTaken();
  EXPECT_TRUE(back);
  other.join();
  EXPECT_FALSE(queue.Take().has_value());
}

TEST(Queue, EveryValueIsTakenUntilItIsDone) {
  constexpr int kValues = 200;
  Queue<int> queue(3);
  std::atomic<int> done{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      while (const std::optional<int> value = queue.Take()) {
        if (*value < kValues) {
          queue.PutBack(*value + kValues);  // each is taken twice
        } else {
          ++done;
          queue.Done();
        }
      }
    });
  }
  for (int i = 0; i < kValues; ++i) EXPECT_TRUE(queue.Put(i));
  queue.Close();
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(done, kValues);
}

TEST(Queue, PutBlocksWhileFullUntilStop) {
  Queue<int> queue(1);
  EXPECT_TRUE(queue.Put(1));
  std::thread putting([&queue] { EXPECT_FALSE(queue.Put(2)); });
  queue.Stop();
  putting.join();
  EXPECT_FALSE(queue.Take().has_value());
}

TEST(Queue, GatherReturnsEarlyWhenFull) {
  Queue<int> queue(4);
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

TEST(Queue, CapacityLimitsTheTotalCost) {
  Queue<int> queue(10);
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
