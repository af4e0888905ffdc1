#include "server/watchdog/step_watch.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace duet::server::watchdog {
namespace {

constexpr common::StepKind kEvaluating{"worker", "evaluating"};
constexpr common::StepKind kLoading{"loader", "loading", /*is_bounded=*/false};

// Threads that a test sets up.
class StepWatchTest : public ::testing::Test {
 protected:
  void Look(double elapsed) { watch_->Look(*threads_, elapsed); }
  std::vector<pid_t> Busy(double seconds, bool every) const {
    std::vector<pid_t> threads;
    watch_->ForEach(seconds, every,
                    [&](const BusyThread& thread) { threads.push_back(thread.thread_id); });
    return threads;
  }

  const std::unique_ptr<common::ThreadStates> threads_ = std::make_unique<common::ThreadStates>();
  const std::unique_ptr<StepWatch> watch_ = std::make_unique<StepWatch>();
};

TEST_F(StepWatchTest, MeasuresAStepInProgress) {
  (*threads_)[3] = {77, &kEvaluating, 1};
  Look(1);
  EXPECT_EQ(watch_->longest().seconds, 0) << "it may have begun just now";
  Look(2);
  Look(3);
  EXPECT_EQ(watch_->longest().seconds, 5);
  EXPECT_EQ(watch_->longest().thread_id, 77);
  EXPECT_EQ(watch_->longest().step, &kEvaluating);
}

TEST_F(StepWatchTest, NewBeatRestartsTheTime) {
  (*threads_)[0] = {77, &kEvaluating, 1};
  Look(1);
  Look(2);
  (*threads_)[0].beat = 2;  // another step of the same kind
  Look(4);
  EXPECT_EQ(watch_->longest().seconds, 0);
  Look(1);
  EXPECT_EQ(watch_->longest().seconds, 1);
}

TEST_F(StepWatchTest, AnIdleThreadIsNeverStuck) {
  (*threads_)[0] = {77, nullptr, 1};
  for (int i = 0; i < 5; ++i) Look(1000);
  EXPECT_EQ(watch_->longest().step, nullptr);
  EXPECT_EQ(watch_->longest().seconds, 0);
  EXPECT_TRUE(Busy(0, /*every=*/true).empty());
}

TEST_F(StepWatchTest, NewThreadInTheSameSlotRestartsTheTime) {
  (*threads_)[0] = {77, &kEvaluating, 1};
  Look(1);
  Look(9);
  (*threads_)[0].thread_id = 78;
  Look(9);
  EXPECT_EQ(watch_->longest().seconds, 0);
}

TEST_F(StepWatchTest, LongestIgnoresUnboundedSteps) {
  (*threads_)[0] = {77, &kLoading, 1};
  (*threads_)[1] = {78, nullptr, 1};
  Look(1);
  Look(100);
  (*threads_)[1] = {78, &kEvaluating, 2};
  Look(1);
  Look(1);
  EXPECT_EQ(watch_->longest().thread_id, 78);
  EXPECT_EQ(watch_->longest().seconds, 1);
  EXPECT_EQ(Busy(1, /*every=*/false), std::vector<pid_t>{78});
  EXPECT_EQ(Busy(1, /*every=*/true), (std::vector<pid_t>{77, 78}));
  EXPECT_EQ(Busy(2, /*every=*/true), std::vector<pid_t>{77});
}

}  // namespace
}  // namespace duet::server::watchdog
