#include <vector>

#include "client/batch/flow/call_gate.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace duet::client::batch::flow {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Time kStart{};

Options Limits(int max_in_flight = 64) {
  Options options;
  options.max_in_flight = max_in_flight;
  options.first_backoff = milliseconds(100);
  options.longest_backoff = seconds(1);
  return options;
}

// Starts as many calls as may start.
std::vector<int64_t> Fill(CallWindow* window, Time now = kStart) {
  std::vector<int64_t> calls;
  while (window->MayStart(now)) calls.push_back(window->Start());
  return calls;
}

void FinishAll(const std::vector<int64_t>& calls, CallEnd end, CallWindow* window,
               Time now = kStart) {
  for (const int64_t call : calls) window->Finish(call, end, std::nullopt, now);
}

TEST(CallWindow, GrowsWithEachAnswerBeforeTheFirstRefusal) {
  CallWindow window(Limits());
  const int first = window.limit();
  FinishAll(Fill(&window), CallEnd::kAnswered, &window);
  EXPECT_GT(window.limit(), first);
  for (int i = 0; i < 20; ++i) FinishAll(Fill(&window), CallEnd::kAnswered, &window);
  EXPECT_GT(window.limit(), 15);
}

TEST(CallWindow, StopsAtItsMaximum) {
  CallWindow window(Limits(5));
  for (int i = 0; i < 20; ++i) FinishAll(Fill(&window), CallEnd::kAnswered, &window);
  EXPECT_EQ(window.limit(), 5);
}

TEST(CallWindow, DoesNotGrowWhileItIsNotFull) {
  CallWindow window(Limits());
  FinishAll(Fill(&window), CallEnd::kAnswered, &window);
  const int limit = window.limit();
  for (int i = 0; i < 100; ++i) {
    window.Finish(window.Start(), CallEnd::kAnswered, std::nullopt, kStart);
  }
  EXPECT_EQ(window.limit(), limit);
}

TEST(CallWindow, HalvesOnceForAllCallsInFlight) {
  CallWindow window(Limits());
  for (int i = 0; i < 20; ++i) FinishAll(Fill(&window), CallEnd::kAnswered, &window);
  const int before = window.limit();
  FinishAll(Fill(&window), CallEnd::kRefused, &window);
  EXPECT_EQ(window.limit(), before / 2);
  const Time later = kStart + seconds(1);
  FinishAll(Fill(&window, later), CallEnd::kRefused, &window, later);
  EXPECT_EQ(window.limit(), before / 4);
}

TEST(CallWindow, GrowsByOneForEachFullWindowAfterARefusal) {
  CallWindow window(Limits());
  for (int i = 0; i < 20; ++i) FinishAll(Fill(&window), CallEnd::kAnswered, &window);
  FinishAll(Fill(&window), CallEnd::kRefused, &window);
  const int limit = window.limit();
  const Time later = kStart + seconds(1);
  // Keeps it full: an answer, and the next call in its place.
  std::vector<int64_t> calls = Fill(&window, later);
  for (int i = 0; i < limit + 1; ++i) {
    window.Finish(calls[static_cast<size_t>(i)], CallEnd::kAnswered, std::nullopt, later);
    while (window.MayStart(later)) calls.push_back(window.Start());
  }
  EXPECT_EQ(window.limit(), limit + 1);
}

TEST(CallWindow, RespectsTheServersDelay) {
  CallWindow window(Limits());
  window.Finish(window.Start(), CallEnd::kRefused, seconds(3), kStart);
  EXPECT_FALSE(window.MayStart(kStart + milliseconds(2999)));
  EXPECT_TRUE(window.MayStart(kStart + seconds(3)));
}

TEST(CallWindow, ProbesAtIncreasingIntervalsWhileTheServerIsAway) {
  CallWindow window(Limits());
  for (int i = 0; i < 20; ++i) FinishAll(Fill(&window), CallEnd::kAnswered, &window);
  FinishAll(Fill(&window), CallEnd::kAway, &window);
  EXPECT_EQ(window.limit(), 1);
  EXPECT_TRUE(window.away());
  Time now = kStart;
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

}  // namespace
}  // namespace duet::client::batch::flow
