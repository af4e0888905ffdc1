#include "server/tracing/span_queue.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace duet::server::tracing {
namespace {

// Far longer than anything here takes: a missing event fails its test instead of hanging it.
constexpr std::chrono::seconds kLongestWait(60);

// A collector that blocks until the test opens it, and accepts or rejects spans.
class Collector {
 public:
  explicit Collector(bool open = true, bool takes = true) : open_(open), takes_(takes) {}

  bool Take(const std::vector<Span>& spans) {
    common::MutexLock lock(mutex_);
    ++asked_;
    changed_.NotifyAll();
    while (!open_) changed_.Wait(mutex_);
    for (const Span& span : spans) names_.push_back(span.name);
    sizes_.push_back(spans.size());
    changed_.NotifyAll();
    return takes_;
  }
  void Open() {
    common::MutexLock lock(mutex_);
    open_ = true;
    changed_.NotifyAll();
  }
  void WaitUntilAsked(int times) {
    const auto end = std::chrono::steady_clock::now() + kLongestWait;
    common::MutexLock lock(mutex_);
    while (asked_ < times && changed_.WaitUntil(mutex_, end)) {
    }
    EXPECT_GE(asked_, times);
  }
  void WaitForSpans(std::size_t count) {
    const auto end = std::chrono::steady_clock::now() + kLongestWait;
    common::MutexLock lock(mutex_);
    while (names_.size() < count && changed_.WaitUntil(mutex_, end)) {
    }
    EXPECT_GE(names_.size(), count);
  }
  std::vector<std::string> names() {
    common::MutexLock lock(mutex_);
    return names_;
  }
  std::vector<std::size_t> sizes() {
    common::MutexLock lock(mutex_);
    return sizes_;
  }

 private:
  common::Mutex mutex_;
  common::CondVar changed_;
  bool open_ DUET_GUARDED_BY(mutex_);
  const bool takes_;
  int asked_ DUET_GUARDED_BY(mutex_) = 0;
  std::vector<std::string> names_ DUET_GUARDED_BY(mutex_);
  std::vector<std::size_t> sizes_ DUET_GUARDED_BY(mutex_);
};

Span Named(const std::string& name) {
  Span span;
  span.name = name;
  return span;
}

SpanQueue::Options To(Collector& collector, std::size_t capacity, std::size_t batch,
                      std::chrono::milliseconds interval) {
  SpanQueue::Options options;
  options.capacity = capacity;
  options.batch_size = batch;
  options.interval = interval;
  options.send = [&collector](const std::vector<Span>& spans) { return collector.Take(spans); };
  return options;
}

constexpr std::chrono::hours kNever(24);
constexpr std::chrono::milliseconds kSoon(1);

TEST(SpanQueueTest, SendsAFullBatchAtOnce) {
  Collector collector;
  SpanQueue queue(To(collector, 100, 2, kNever));
  queue.Add(Named("a"));
  queue.Add(Named("b"));
  collector.WaitForSpans(2);
  EXPECT_EQ(collector.names(), (std::vector<std::string>{"a", "b"}));
}

TEST(SpanQueueTest, SendsASmallBatchAfterTheInterval) {
  Collector collector;
  SpanQueue queue(To(collector, 100, 50, kSoon));
  queue.Add(Named("a"));
  collector.WaitForSpans(1);
}

TEST(SpanQueueTest, DestructorSendsTheRemainingSpansInBatches) {
  Collector collector;
  {
    SpanQueue queue(To(collector, 100, 50, kNever));
    for (int i = 0; i < 49; ++i) queue.Add(Named("a"));
  }
  EXPECT_EQ(collector.sizes(), (std::vector<std::size_t>{49}));
}

TEST(SpanQueueTest, FullQueueDropsAndCountsSpansWithoutBlocking) {
  Collector collector(/*open=*/false);
  SpanQueue queue(To(collector, 3, 1, kNever));
  queue.Add(Named("first"));
  collector.WaitUntilAsked(1);  // stuck with the first
  for (int i = 0; i < 5; ++i) queue.Add(Named("more"));
  EXPECT_EQ(queue.dropped(), 2u);
  collector.Open();
  collector.WaitForSpans(4);
}

TEST(SpanQueueTest, UnreachableCollectorDoesNotDelayTheEnd) {
  Collector collector(/*open=*/true, /*takes=*/false);
  {
    SpanQueue queue(To(collector, 100, 1, kNever));
    queue.Add(Named("a"));
    collector.WaitForSpans(1);
    queue.Add(Named("b"));
    collector.WaitForSpans(2);
    EXPECT_EQ(queue.sent(), 0u);
  }
  Collector away(/*open=*/true, /*takes=*/false);
  {
    SpanQueue queue(To(away, 100, 10, kNever));
    for (int i = 0; i < 9; ++i) queue.Add(Named("c"));
  }
  EXPECT_EQ(away.sizes().size(), 1u);
}

TEST(SpanQueueTest, ConcurrentSpansAreAllSent) {
  Collector collector;
  {
    SpanQueue queue(To(collector, 10000, 64, kSoon));
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&queue] {
        for (int i = 0; i < 250; ++i) queue.Add(Named("x"));
      });
    }
    for (std::thread& thread : threads) thread.join();
  }
  EXPECT_EQ(collector.names().size(), 1000u);
}

}  // namespace
}  // namespace duet::server::tracing
