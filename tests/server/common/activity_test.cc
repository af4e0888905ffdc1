#include "server/common/activity.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>
#include <optional>
#include <thread>

namespace duet::server::common {
namespace {

constexpr StepKind kOuter{"tester", "outer"};
constexpr StepKind kInner{"tester", "inner"};

// The state of a thread as the watchdog reads it; nullopt if there is none.
std::optional<ThreadState> See(pid_t thread_id) {
  const auto states = std::make_unique<ThreadStates>();
  ReadThreads(states.get());
  for (const ThreadState& state : *states) {
    if (state.thread_id == thread_id) return state;
  }
  return std::nullopt;
}

TEST(ActivityTest, StepIsVisibleWhileItLasts) {
  {
    const Step step(kOuter);
    EXPECT_EQ(See(gettid())->step, &kOuter);
  }
  EXPECT_EQ(See(gettid())->step, nullptr);
}

TEST(ActivityTest, NestedStepReplacesTheOuterOneUntilItEnds) {
  const Step outer(kOuter);
  {
    const Step inner(kInner);
    EXPECT_EQ(See(gettid())->step, &kInner);
    const Idle idle;
    EXPECT_EQ(See(gettid())->step, nullptr);
  }
  EXPECT_EQ(See(gettid())->step, &kOuter);
}

TEST(ActivityTest, BeatChangesAtEachBeginAndEnd) {
  const Step outer(kOuter);
  const auto first = See(gettid())->beat;
  EXPECT_EQ(See(gettid())->beat, first) << "reading is no progress";
  std::optional<Step> inner(kInner);
  const auto second = See(gettid())->beat;
  EXPECT_NE(second, first);
  inner.reset();
  EXPECT_NE(See(gettid())->beat, second);
  EXPECT_NE(See(gettid())->beat, first);
}

TEST(ActivityTest, EndedThreadIsNotVisible) {
  pid_t thread_id = 0;
  std::thread([&thread_id] {
    const Step step(kOuter);
    thread_id = gettid();
    EXPECT_TRUE(See(thread_id).has_value());
  }).join();
  EXPECT_FALSE(See(thread_id).has_value());
}

}  // namespace
}  // namespace duet::server::common
