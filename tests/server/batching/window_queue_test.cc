#include "server/batching/window_queue.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace duet::server::batching {
namespace {

// A job that its deadline tells from others.
WindowJob Job(Priority priority, int number, bool continues_call = false) {
  WindowJob job;
  job.priority = priority;
  job.deadline = common::TimePoint(std::chrono::seconds(number));
  job.continues_call = continues_call;
  return job;
}

int NumberOf(const QueuedWindow& window) {
  return static_cast<int>(
      std::chrono::duration_cast<std::chrono::seconds>(window.job.deadline.time_since_epoch())
          .count());
}

std::vector<int> PopAll(WindowQueue& queue) {
  std::vector<int> numbers;
  while (std::optional<QueuedWindow> window = queue.Pop()) numbers.push_back(NumberOf(*window));
  return numbers;
}

TEST(WindowQueueTest, IsEmptyAtFirst) {
  WindowQueue queue(4);
  EXPECT_EQ(queue.size(), 0u);
  EXPECT_FALSE(queue.Pop().has_value());
}

TEST(WindowQueueTest, GivesWindowsOfOnePriorityInTheOrderTheyCame) {
  WindowQueue queue(4);
  for (int i = 1; i <= 3; ++i) queue.Push({Job(Priority::kInteractive, i), {}});
  EXPECT_EQ(PopAll(queue), (std::vector<int>{1, 2, 3}));
}

TEST(WindowQueueTest, InteractiveGoesBeforeBulkThatCameEarlier) {
  WindowQueue queue(4);
  queue.Push({Job(Priority::kBulk, 1), {}});
  queue.Push({Job(Priority::kInteractive, 2), {}});
  queue.Push({Job(Priority::kBulk, 3), {}});
  queue.Push({Job(Priority::kInteractive, 4), {}});
  EXPECT_EQ(PopAll(queue), (std::vector<int>{2, 4, 1, 3}));
}

TEST(WindowQueueTest, TakesNoNewCallWhenFull) {
  WindowQueue queue(2);
  EXPECT_TRUE(queue.HasRoomFor(Job(Priority::kInteractive, 1)));
  queue.Push({Job(Priority::kInteractive, 1), {}});
  queue.Push({Job(Priority::kInteractive, 2), {}});
  EXPECT_FALSE(queue.HasRoomFor(Job(Priority::kInteractive, 3)));
}

TEST(WindowQueueTest, AlwaysTakesTheNextWindowOfACallBegun) {
  WindowQueue queue(1);
  queue.Push({Job(Priority::kInteractive, 1), {}});
  EXPECT_TRUE(queue.HasRoomFor(Job(Priority::kInteractive, 2, /*continues_call=*/true)));
  EXPECT_TRUE(queue.HasRoomFor(Job(Priority::kBulk, 2, /*continues_call=*/true)));
}

TEST(WindowQueueTest, KeepsAQuarterFreeOfBulk) {
  WindowQueue queue(4);
  for (int i = 1; i <= 3; ++i) {
    ASSERT_TRUE(queue.HasRoomFor(Job(Priority::kBulk, i)));
    queue.Push({Job(Priority::kBulk, i), {}});
  }
  EXPECT_FALSE(queue.HasRoomFor(Job(Priority::kBulk, 4)));
  EXPECT_TRUE(queue.HasRoomFor(Job(Priority::kInteractive, 4)));
}

TEST(WindowQueueTest, WaitingInteractiveWindowsLeaveLessRoomForBulk) {
  WindowQueue queue(4);
  for (int i = 1; i <= 2; ++i) queue.Push({Job(Priority::kInteractive, i), {}});
  EXPECT_TRUE(queue.HasRoomFor(Job(Priority::kBulk, 3)));
  queue.Push({Job(Priority::kInteractive, 3), {}});
  EXPECT_FALSE(queue.HasRoomFor(Job(Priority::kBulk, 4)));
  EXPECT_TRUE(queue.HasRoomFor(Job(Priority::kInteractive, 4)));
}

TEST(ShareOfTest, LeavesSomethingToBulkWhateverTheLimit) {
  EXPECT_EQ(ShareOf(1, Priority::kBulk), 1u);
  EXPECT_EQ(ShareOf(4, Priority::kBulk), 3u);
  EXPECT_EQ(ShareOf(128, Priority::kBulk), 96u);
  EXPECT_EQ(ShareOf(128, Priority::kInteractive), 128u);
}

}  // namespace
}  // namespace duet::server::batching
