#include <atomic>
#include <thread>
#include <vector>

#include "client/batch/flow/queues.h"
#include "gtest/gtest.h"

namespace duet::client::batch::flow {
namespace {

TEST(WorkQueue, ReturnedValuesComeFirst) {
  WorkQueue<int> queue(4);
  queue.Put(1);
  queue.Put(2);
  EXPECT_EQ(queue.Take(), 1);
  queue.PutBack(1);
  EXPECT_EQ(queue.Take(), 1);
  EXPECT_EQ(queue.Take(), 2);
}

TEST(WorkQueue, EndsWhenAllValuesAreDone) {
  WorkQueue<int> queue(4);
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

TEST(WorkQueue, StopDropsQueuedValuesAndWaitsForTakenOnes) {
  WorkQueue<int> queue(2);
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

TEST(WorkQueue, EveryValueIsTakenUntilItIsDone) {
  constexpr int kValues = 200;
  WorkQueue<int> queue(3);
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

}  // namespace
}  // namespace duet::client::batch::flow
