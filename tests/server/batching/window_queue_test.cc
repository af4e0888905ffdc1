#include "server/batching/window_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"

namespace duet::server::batching {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::FakeSynthesizer;

using Model = std::shared_ptr<const engine::Synthesizer>;

constexpr common::TimePoint kNow(seconds(1000));
constexpr int kFrames = 4;

Model NewModel() { return std::make_shared<FakeSynthesizer>(); }

WindowJob Job(const Model& model, Priority priority = Priority::kInteractive,
              int frames = kFrames) {
  WindowJob job;
  job.model = model;
  job.window.leader = motion::Poses(frames, 15);
  job.priority = priority;
  job.cancelled = std::make_shared<std::atomic<bool>>(false);
  return job;
}

WindowJob LaterJob(const Model& model, Priority priority = Priority::kInteractive) {
  WindowJob job = Job(model, priority);
  job.continues_call = true;
  return job;
}

BatcherOptions Options(int workers, int max_windows) { return {workers, 64, {max_windows}}; }

// A worker asks, and evaluates what it gets in this time; how many windows of which priority.
struct Served {
  std::size_t windows = 0;
  Priority priority = Priority::kInteractive;
  Model model;
};
Served Serve(WindowQueue& queue, common::TimePoint now, milliseconds takes) {
  const Turn turn = queue.Next(now);
  if (turn.batch.windows.empty()) return {};
  queue.Finished(turn.batch, now + takes);
  const WindowJob& job = turn.batch.windows.front().job;
  return {turn.batch.windows.size(), job.priority, job.model};
}

TEST(WindowQueueTest, RejectsNewCallsWhenFull) {
  const Model model = NewModel();
  WindowQueue queue({1, 2, {1}});
  EXPECT_TRUE(queue.HasRoomFor(Job(model), kNow));
  queue.Push(Job(model), kNow);
  queue.Push(Job(model), kNow);
  EXPECT_FALSE(queue.HasRoomFor(Job(model), kNow));
  Serve(queue, kNow, milliseconds(1));
  EXPECT_TRUE(queue.HasRoomFor(Job(model), kNow));
}

TEST(WindowQueueTest, StartedCallsUseNoRoomOfNewOnes) {
  const Model model = NewModel();
  WindowQueue queue({1, 1, {1}});
  for (int i = 0; i < 66; ++i) queue.Push(LaterJob(model), kNow);
  EXPECT_TRUE(queue.HasRoomFor(Job(model), kNow));
  queue.Push(Job(model), kNow);
  EXPECT_FALSE(queue.HasRoomFor(Job(model), kNow));
  EXPECT_TRUE(queue.HasRoomFor(LaterJob(model), kNow)) << "nor need they any";
  EXPECT_TRUE(queue.HasRoomFor(LaterJob(model, Priority::kBulk), kNow));
  EXPECT_EQ(queue.size(), 67u);
}

TEST(WindowQueueTest, WindowsThatNeverStartUseNoRoom) {
  const Model model = NewModel();
  WindowQueue queue({1, 2, {1}});
  WindowJob cancelled = Job(model), expired = Job(model);
  const auto flag = std::make_shared<std::atomic<bool>>(false);
  cancelled.cancelled = flag;
  expired.deadline = kNow + seconds(1);
  queue.Push(std::move(cancelled), kNow);
  queue.Push(std::move(expired), kNow);
  EXPECT_FALSE(queue.HasRoomFor(Job(model), kNow));
  EXPECT_TRUE(queue.HasRoomFor(Job(model), kNow + seconds(1)));
  flag->store(true);
  EXPECT_TRUE(queue.HasRoomFor(Job(model), kNow));
}

TEST(WindowQueueTest, ReservesAQuarterForInteractiveCalls) {
  const Model model = NewModel();
  WindowQueue queue({1, 4, {1}});
  for (int i = 1; i <= 3; ++i) {
    ASSERT_TRUE(queue.HasRoomFor(Job(model, Priority::kBulk), kNow));
    queue.Push(Job(model, Priority::kBulk), kNow);
  }
  EXPECT_FALSE(queue.HasRoomFor(Job(model, Priority::kBulk), kNow));
  EXPECT_TRUE(queue.HasRoomFor(Job(model), kNow));
  EXPECT_EQ(ShareOf(1, Priority::kBulk), 1u) << "some room at every limit";
}

TEST(WindowQueueTest, DropsCancelledAndExpiredWindows) {
  const Model model = NewModel();
  WindowQueue queue(Options(1, 4));
  WindowJob cancelled = Job(model), expired = Job(model);
  const auto flag = std::make_shared<std::atomic<bool>>(false);
  cancelled.cancelled = flag;
  expired.deadline = kNow + seconds(1);
  queue.Push(std::move(cancelled), kNow);
  queue.Push(std::move(expired), kNow);
  queue.Push(Job(model), kNow);
  flag->store(true);
  const Turn turn = queue.Next(kNow + seconds(2));
  ASSERT_EQ(turn.dropped.size(), 2u);
  EXPECT_THAT(turn.dropped[0].reason, StatusIs(absl::StatusCode::kCancelled, ::testing::_));
  EXPECT_THAT(turn.dropped[1].reason, StatusIs(absl::StatusCode::kDeadlineExceeded, ::testing::_));
  EXPECT_EQ(turn.batch.windows.size(), 1u);
  EXPECT_EQ(queue.size(), 0u);
}

TEST(WindowQueueTest, LearnsWhatABatchCosts) {
  const Model model = NewModel();
  WindowQueue queue(Options(1, 4));
  queue.Push(Job(model), kNow);
  EXPECT_EQ(Serve(queue, kNow, milliseconds(20)).windows, 1u);
  const common::TimePoint now = kNow + milliseconds(20);
  WindowJob hopeless = Job(model), sound = Job(model);
  // Seven eighths of which are for the model.
  hopeless.deadline = now + milliseconds(22);
  sound.deadline = now + milliseconds(23);
  queue.Push(std::move(hopeless), now);
  queue.Push(std::move(sound), now);
  const Turn turn = queue.Next(now);
  EXPECT_EQ(turn.dropped.size(), 1u);
  EXPECT_EQ(turn.batch.windows.size(), 1u);
  EXPECT_NEAR(turn.batch.expected_seconds, 0.02, 1e-9);
}

TEST(WindowQueueTest, EmptyLaneAccumulatesNoClaims) {
  const Model model = NewModel();
  WindowQueue queue(Options(1, 1));
  const auto serve_interactive = [&](int times) {
    for (int i = 0; i < times; ++i) {
      queue.Push(Job(model), kNow);
      EXPECT_EQ(Serve(queue, kNow, milliseconds(1)).priority, Priority::kInteractive);
    }
  };
  WindowJob given_up = Job(model, Priority::kBulk);
  const auto flag = std::make_shared<std::atomic<bool>>(false);
  given_up.cancelled = flag;
  queue.Push(std::move(given_up), kNow);
  serve_interactive(6);
  flag->store(true);
  serve_interactive(1);
  queue.Push(Job(model, Priority::kBulk), kNow);
  serve_interactive(7);
  queue.Push(Job(model), kNow);
  EXPECT_EQ(Serve(queue, kNow, milliseconds(1)).priority, Priority::kBulk);
}

// Two models, the second four times as slow: each gets half of the time.
TEST(WindowQueueTest, ModelsShareComputingTime) {
  const Model fast = NewModel(), slow = NewModel();
  WindowQueue queue(Options(1, 2));
  common::TimePoint now = kNow;
  milliseconds fast_time(0), slow_time(0);
  for (int i = 0; i < 8; ++i) queue.Push(LaterJob(i % 2 == 0 ? fast : slow), now);
  for (int i = 0; i < 500; ++i) {
    const Turn turn = queue.Next(now);
    const bool is_fast = turn.batch.windows[0].job.model == fast;
    const milliseconds takes(is_fast ? 5 : 20);
    for (std::size_t n = 0; n < turn.batch.windows.size(); ++n) {
      queue.Push(LaterJob(is_fast ? fast : slow), now);
    }
    (is_fast ? fast_time : slow_time) += takes;
    now += takes;
    queue.Finished(turn.batch, now);
  }
  EXPECT_NEAR(static_cast<double>(fast_time.count()), static_cast<double>(slow_time.count()), 40);
}

TEST(WindowQueueTest, IdleModelAccumulatesNoClaims) {
  const Model busy = NewModel(), idle = NewModel();
  WindowQueue queue(Options(1, 1));
  common::TimePoint now = kNow;
  queue.Push(Job(idle), now);
  Serve(queue, now, milliseconds(10));
  for (int i = 0; i < 100; ++i) {
    queue.Push(Job(busy), now);
    Serve(queue, now, milliseconds(10));
    now += milliseconds(10);
  }
  int of_busy = 0;
  for (int i = 0; i < 10; ++i) {
    queue.Push(Job(busy), now);
    queue.Push(Job(idle), now);
    of_busy += Serve(queue, now, milliseconds(10)).model == busy ? 1 : 0;
    now += milliseconds(10);
  }
  EXPECT_GE(of_busy, 4);
  EXPECT_LE(of_busy, 6);
}

TEST(WindowQueueTest, ReleasesRemovedModels) {
  WindowQueue queue(Options(1, 1));
  Model model = NewModel();
  const std::weak_ptr<const engine::Synthesizer> watched = model;
  queue.Push(Job(model), kNow);
  Serve(queue, kNow, milliseconds(1));
  model.reset();
  EXPECT_TRUE(watched.expired());
  queue.Push(Job(NewModel()), kNow);
  EXPECT_EQ(Serve(queue, kNow, milliseconds(1)).windows, 1u);
}

TEST(WindowQueueTest, DropAllReportsTheReason) {
  const Model model = NewModel();
  WindowQueue queue(Options(1, 1));
  WindowJob expired = Job(model);
  expired.deadline = kNow;
  queue.Push(Job(model), kNow);
  queue.Push(std::move(expired), kNow);
  const std::vector<DroppedWindow> dropped = queue.DropAll(absl::UnavailableError("over"), kNow);
  ASSERT_EQ(dropped.size(), 2u);
  EXPECT_THAT(dropped[0].reason, StatusIs(absl::StatusCode::kDeadlineExceeded, ::testing::_));
  EXPECT_THAT(dropped[1].reason, StatusIs(absl::StatusCode::kUnavailable, "over"));
  EXPECT_EQ(queue.size(), 0u);
}

TEST(WindowQueueTest, WaitsForMoreWindowsAfterABatchOfSeveral) {
  const Model model = NewModel();
  WindowQueue queue({1, 64, {4, milliseconds(50)}});
  queue.Push(Job(model), kNow);
  EXPECT_EQ(Serve(queue, kNow, milliseconds(0)).windows, 1u);
  queue.Push(Job(model), kNow);
  EXPECT_EQ(Serve(queue, kNow, milliseconds(0)).windows, 1u) << "a lone call, one after the other";
  for (int i = 0; i < 2; ++i) queue.Push(Job(model), kNow);
  EXPECT_EQ(Serve(queue, kNow, milliseconds(0)).windows, 2u);
  queue.Push(Job(model), kNow + milliseconds(10));
  EXPECT_EQ(queue.Next(kNow + milliseconds(10)).look_again, kNow + milliseconds(50));
}

TEST(LaneTest, DependsOnPriorityAndOnTheCallsLength) {
  constexpr int kLong = kShortCallWindows + 1;
  EXPECT_EQ(LaneOf(Priority::kInteractive, 1, false), Lane::kShort);
  EXPECT_EQ(LaneOf(Priority::kInteractive, kShortCallWindows, true), Lane::kShort);
  EXPECT_EQ(LaneOf(Priority::kInteractive, kLong, true), Lane::kLong);
  EXPECT_EQ(LaneOf(Priority::kInteractive, kLong, false), Lane::kShort) << "its first window";
  EXPECT_EQ(LaneOf(Priority::kBulk, 1, false), Lane::kBulk);
  EXPECT_EQ(LaneOf(Priority::kBulk, kLong, true), Lane::kBulk);
}

WindowJob JobOf(const Model& model, const std::string& client) {
  WindowJob job = Job(model);
  job.client = client;
  return job;
}

// A job of a model that samples, whose window is as long as its windows can be.
WindowJob SamplingJob(const Model& model, int candidates, const std::string& client = "") {
  WindowJob job = Job(model, Priority::kInteractive, model->description().window_frames);
  job.window.options.sampling.candidates = candidates;
  job.client = client;
  return job;
}

Model NewSampler() { return std::make_shared<FakeSynthesizer>(test::SamplingDescription()); }

TEST(WindowQueueTest, CandidatesTakeRoom) {
  const Model sampler = NewSampler();
  WindowQueue queue({1, 8, {1}});
  queue.Push(SamplingJob(sampler, 5), kNow);
  EXPECT_TRUE(queue.HasRoomFor(SamplingJob(sampler, 3), kNow));
  EXPECT_FALSE(queue.HasRoomFor(SamplingJob(sampler, 4), kNow));
  EXPECT_TRUE(queue.HasRoomFor(Priority::kInteractive, "", kNow));
  WindowJob without_samples = Job(NewModel());
  without_samples.window.options.sampling.candidates = 4;
  EXPECT_TRUE(queue.HasRoomFor(without_samples, kNow)) << "its model ignores them";
  EXPECT_EQ(queue.candidates(), 5u);
}

TEST(WindowQueueTest, AClientLeavesRoomForOthers) {
  const Model sampler = NewSampler();
  for (const int candidates : {1, 3}) {  // one by one, or some at once
    BatcherOptions options{1, 8, {1}};
    options.client_share = 0.75;
    WindowQueue queue(options);
    int greedy = 0;
    for (; queue.HasRoomFor(SamplingJob(sampler, candidates, "greedy"), kNow); ++greedy) {
      queue.Push(SamplingJob(sampler, candidates, "greedy"), kNow);
    }
    EXPECT_EQ(greedy * candidates, 6);
    EXPECT_TRUE(queue.HasRoomFor(SamplingJob(sampler, 1, "other"), kNow));
  }
}

TEST(WindowQueueTest, CallWithManyCandidatesIsLong) {
  const Model sampler = NewSampler();
  WindowQueue queue(Options(1, 1));
  for (const int candidates : {kShortCallWindows + 1, kShortCallWindows}) {
    WindowJob job = SamplingJob(sampler, candidates);
    job.continues_call = true;
    queue.Push(std::move(job), kNow);
  }
  EXPECT_EQ(queue.Next(kNow).batch.Candidates(), kShortCallWindows);
}

TEST(WindowQueueTest, ReturningClientClaimsNoTurnsOfItsAbsence) {
  const Model model = NewModel();
  WindowQueue queue(Options(1, 1));
  queue.Push(JobOf(model, "returning"), kNow);
  for (int i = 0; i < 100; ++i) queue.Push(JobOf(model, "busy"), kNow);
  const auto next = [&] {
    const Turn turn = queue.Next(kNow);
    queue.Finished(turn.batch, kNow);
    return turn.batch.windows[0].job.client;
  };
  for (int i = 0; i < 50; ++i) next();
  for (int i = 0; i < 4; ++i) queue.Push(JobOf(model, "returning"), kNow);
  std::vector<std::string> order;
  for (int i = 0; i < 6; ++i) order.push_back(next());
  EXPECT_EQ(std::count(order.begin(), order.end(), "busy"), 3);
}

TEST(WindowQueueTest, OrdersWindowsByTheTimeAtWhichTheyAreDue) {
  const Model model = NewModel();
  WindowQueue queue(Options(1, 1));
  for (const milliseconds left : {milliseconds(33), milliseconds(-500), milliseconds(10)}) {
    WindowJob job = Job(model);
    job.due = kNow + left;
    queue.Push(std::move(job), kNow);
  }
  std::vector<common::TimePoint> order;
  for (int i = 0; i < 3; ++i) {
    const Turn turn = queue.Next(kNow);
    ASSERT_EQ(turn.batch.windows.size(), 1u);
    order.push_back(turn.batch.windows[0].job.due);
    queue.Finished(turn.batch, kNow);
  }
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

// A queue of a model whose windows take 10 ms each.
class ComesInTimeTest : public ::testing::Test {
 protected:
  ComesInTimeTest() {
    queue_.Push(Job(model_), kNow);
    Serve(queue_, kNow, milliseconds(10));
  }
  WindowJob Due(milliseconds left) const {
    WindowJob job = Job(model_);
    job.deadline = now_ + left;
    return job;
  }
  const Model model_ = NewModel();
  const common::TimePoint now_ = kNow + milliseconds(10);
  WindowQueue queue_{Options(1, 1)};
};

TEST_F(ComesInTimeTest, CountsRunningBatchesAndEarlierWindows) {
  queue_.Push(Job(model_), now_);
  const Turn turn = queue_.Next(now_);
  for (int i = 0; i < 5; ++i) queue_.Push(Job(model_), now_);
  // 10 ms run, 50 wait, and its own 10.
  EXPECT_TRUE(queue_.ComesInTime(Due(milliseconds(71)), now_));
  EXPECT_FALSE(queue_.ComesInTime(Due(milliseconds(69)), now_));
  EXPECT_TRUE(queue_.ComesInTime(Job(model_), now_)) << "it has no deadline";
}

TEST_F(ComesInTimeTest, CountsEveryCandidate) {
  const Model sampling = std::make_shared<FakeSynthesizer>(test::SamplingDescription());
  queue_.Push(Job(sampling), now_);
  Serve(queue_, now_, milliseconds(10));
  const common::TimePoint now = now_ + milliseconds(10);
  const auto due = [&](const Model& model, milliseconds left) {
    WindowJob job = Job(model);
    job.window.options.sampling.candidates = 4;
    job.deadline = now + left;
    return job;
  };
  queue_.Push(due(sampling, milliseconds(1000)), now);
  // 40 ms and its own 40.
  EXPECT_TRUE(queue_.ComesInTime(due(sampling, milliseconds(81)), now));
  EXPECT_FALSE(queue_.ComesInTime(due(sampling, milliseconds(79)), now));
  // A model that does not sample ignores them: 40 ms and its own 10.
  EXPECT_TRUE(queue_.ComesInTime(due(model_, milliseconds(51)), now));
}

TEST_F(ComesInTimeTest, IgnoresWindowsThatNeverRunOrRunLater) {
  queue_.Push(Job(model_), now_);
  for (int i = 0; i < 6; ++i) queue_.Push(Job(model_, Priority::kBulk), now_);
  const auto cancelled = std::make_shared<std::atomic<bool>>(true);
  for (int i = 0; i < 6; ++i) {
    WindowJob job = Job(model_);
    job.cancelled = cancelled;
    queue_.Push(std::move(job), now_);
    WindowJob late = Job(model_);
    late.deadline = now_;
    queue_.Push(std::move(late), now_);
  }
  EXPECT_TRUE(queue_.ComesInTime(Due(milliseconds(21)), now_));
}

}  // namespace
}  // namespace duet::server::batching
