// How many calls run at a time, and the queues between the threads of a job.
#include <atomic>
#include <optional>
#include <thread>
#include <vector>

#include "client/batch/flow/call_gate.h"
#include "client/batch/flow/queues.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace duet::client::batch::flow {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;

Options Limits(int max_in_flight = 64) {
  Options options;
  options.max_in_flight = max_in_flight;
  options.first_backoff = milliseconds(100);
  options.longest_backoff = seconds(1);
  return options;
}

// A window that a server has let grow by `rounds` full windows of answers.
class GrownWindow : public CallWindow {
 public:
  explicit GrownWindow(const Options& options, int rounds = 20) : CallWindow(options) {
    for (int i = 0; i < rounds; ++i) FinishAll(Fill({}), CallEnd::kAnswered, {});
  }
  // Starts as many calls as may start.
  std::vector<int64_t> Fill(Time now) {
    std::vector<int64_t> calls;
    while (MayStart(now)) calls.push_back(Start());
    return calls;
  }
  void FinishAll(const std::vector<int64_t>& calls, CallEnd end, Time now) {
    for (const int64_t call : calls) Finish(call, end, std::nullopt, now);
  }
};

TEST(CallWindow, GrowsWithEachAnswerToAFullWindowUpToItsMaximum) {
  EXPECT_GT(GrownWindow(Limits(), 1).limit(), CallWindow(Limits()).limit());
  EXPECT_GT(GrownWindow(Limits()).limit(), 15);
  EXPECT_EQ(GrownWindow(Limits(5)).limit(), 5);
  GrownWindow window(Limits(), 1);
  const int limit = window.limit();
  for (int i = 0; i < 100; ++i) window.FinishAll({window.Start()}, CallEnd::kAnswered, {});
  EXPECT_EQ(window.limit(), limit) << "never full";
}

TEST(CallWindow, HalvesOnceForAllCallsInFlightAndThenGrowsByOne) {
  GrownWindow window(Limits());
  const int before = window.limit();
  window.FinishAll(window.Fill({}), CallEnd::kRefused, {});
  EXPECT_EQ(window.limit(), before / 2);
  const Time later = Time{} + seconds(1);
  window.FinishAll(window.Fill(later), CallEnd::kRefused, later);
  const int limit = window.limit();
  EXPECT_EQ(limit, before / 4);
  // Keeps it full: an answer, and the next call in its place.
  const Time now = later + seconds(1);
  std::vector<int64_t> calls = window.Fill(now);
  for (int i = 0; i < limit + 1; ++i) {
    window.Finish(calls[static_cast<size_t>(i)], CallEnd::kAnswered, std::nullopt, now);
    for (const int64_t call : window.Fill(now)) calls.push_back(call);
  }
  EXPECT_EQ(window.limit(), limit + 1);
}

TEST(CallWindow, RespectsTheServersDelay) {
  CallWindow window(Limits());
  window.Finish(window.Start(), CallEnd::kRefused, seconds(3), {});
  EXPECT_FALSE(window.MayStart(Time{} + milliseconds(2999)));
  EXPECT_TRUE(window.MayStart(Time{} + seconds(3)));
}

TEST(CallWindow, ProbesAtIncreasingIntervalsWhileTheServerIsAway) {
  GrownWindow window(Limits());
  window.FinishAll(window.Fill({}), CallEnd::kAway, {});
  EXPECT_EQ(window.limit(), 1);
  EXPECT_TRUE(window.away());
  Time now{};
  std::vector<Duration> waits;
  for (int i = 0; i < 6; ++i) {
    waits.push_back(window.opens() - now);
    now = window.opens();
    window.Finish(window.Start(), CallEnd::kAway, std::nullopt, now);
  }
  EXPECT_THAT(waits, ::testing::ElementsAre(milliseconds(100), milliseconds(200), milliseconds(400),
                                            milliseconds(800), seconds(1), seconds(1)));
  window.Finish(window.Start(), CallEnd::kAnswered, std::nullopt, window.opens());
  EXPECT_FALSE(window.away());
}

TEST(CallGate, NeverStartsMoreCallsThanTheWindow) {
  CallGate gate(Limits(3), hours(1));
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

TEST(Queue, EndsWhenAllValuesAreTaken) {
  Queue<int> queue(4);
  queue.Put(1);
  queue.Put(2);
  queue.Close();
  EXPECT_EQ(queue.Take(), 1);
  EXPECT_EQ(queue.Take(), 2);
  EXPECT_FALSE(queue.Take().has_value());
}

TEST(Queue, StopDropsAllValues) {
  Queue<int> queue(2);
  queue.Put(1);
  queue.Put(2);
  EXPECT_EQ(queue.Take(), 1);
  std::thread putting([&queue] {
    queue.Put(3);
    EXPECT_FALSE(queue.Put(4)) << "blocks while the queue is full";
  });
  queue.Stop();
  putting.join();
  EXPECT_FALSE(queue.Take().has_value());
}

TEST(Queue, EveryValueIsTakenOnce) {
  constexpr int kValues = 200;
  Queue<int> queue(3);
  std::atomic<int> sum{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      while (const std::optional<int> value = queue.Take()) sum += *value;
    });
  }
  for (int i = 0; i < kValues; ++i) EXPECT_TRUE(queue.Put(i));
  queue.Close();
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(sum, kValues * (kValues - 1) / 2);
}

TEST(Queue, GatherReturnsEarlyWhenMoreThanHalfFullOrClosed) {
  Queue<int> queue(4);
  for (int i = 0; i < 3; ++i) queue.Put(i);
  EXPECT_EQ(queue.Gather(hours(1)), (std::vector<int>{0, 1, 2}));
  std::thread late([&queue] {
    queue.Put(4);
    queue.Close();
  });
  EXPECT_EQ(queue.Gather(hours(1)), (std::vector<int>{4}));
  late.join();
  EXPECT_TRUE(queue.Gather(hours(1)).empty());
}

TEST(Queue, CapacityLimitsTheTotalCost) {
  Queue<int> queue(10);
  queue.Put(1, 100);  // more than there is room for: alone
  std::thread putting([&] {
    queue.Put(2, 6);
    queue.Put(3, 6);
  });
  for (const int value : {1, 2, 3}) EXPECT_EQ(queue.Take(), value);
  putting.join();
}

}  // namespace
}  // namespace duet::client::batch::flow
