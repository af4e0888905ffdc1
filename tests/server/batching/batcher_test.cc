#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "server/batching/window_queue.h"
#include "tests/server/support/fakes.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"

namespace duet::server::batching {
namespace {

using std::chrono::milliseconds;
using test::FakeClock;
using test::FakeDescription;
using test::FakeSynthesizer;
using test::GatedModel;
using test::SwayingMotion;

constexpr auto kCancelled = absl::StatusCode::kCancelled;
constexpr auto kInternal = absl::StatusCode::kInternal;
constexpr auto kResourceExhausted = absl::StatusCode::kResourceExhausted;
constexpr auto kUnavailable = absl::StatusCode::kUnavailable;

// A job and its outcome.
struct Ticket {
  std::shared_ptr<std::atomic<bool>> cancelled = std::make_shared<std::atomic<bool>>(false);
  std::shared_ptr<std::promise<WindowOutcome>> promise =
      std::make_shared<std::promise<WindowOutcome>>();
  std::future<WindowOutcome> outcome = promise->get_future();

  WindowJob Job(std::shared_ptr<const engine::Synthesizer> model) const {
    WindowJob job;
    job.window.leader = SwayingMotion(4, 15);
    job.window.labels.assign(4 * model->description().classes.size(), 0.0F);
    job.model = std::move(model);
    job.cancelled = cancelled;
    // set_value throws when called twice, which would end the test program.
    job.done = [promise = promise](WindowOutcome result) { promise->set_value(std::move(result)); };
    return job;
  }
};

TEST(BatcherTest, EvaluatesAsManyBatchesAtOnceAsThereAreWorkers) {
  const auto batcher = MakeBatcher({2, 4, {4}}, common::Clock::Real());
  GatedModel model;
  Ticket first, second;
  ASSERT_THAT(batcher->Submit(first.Job(model.get())), IsOk());
  ASSERT_THAT(batcher->Submit(second.Job(model.get())), IsOk());
  model.WaitUntilStarted(2);  // would wait for ever with one worker
  model.Open();
  EXPECT_THAT(first.outcome.get().result, IsOk());
  EXPECT_THAT(second.outcome.get().result, IsOk());
}

TEST(BatcherTest, NeverStartsACancelledWindow) {
  GatedModel model;
  const auto batcher = MakeBatcher({1, 4, {4}}, common::Clock::Real());
  Ticket running, cancelled;
  ASSERT_THAT(batcher->Submit(running.Job(model.get())), IsOk());
  model.WaitUntilStarted(1);
  ASSERT_THAT(batcher->Submit(cancelled.Job(model.get())), IsOk());
  cancelled.cancelled->store(true);
  model.Open();
  const WindowOutcome outcome = cancelled.outcome.get();
  EXPECT_THAT(outcome.result, StatusIs(kCancelled, HasSubstr("before this window started")));
  EXPECT_EQ(outcome.timings.batch_size, 0);
  EXPECT_EQ(model.started(), 1);
}

TEST(BatcherTest, ModelSeesCancellationDuringABatch) {
  const auto batcher = MakeBatcher({1, 4, {4}}, common::Clock::Real());
  const auto model = std::make_shared<FakeSynthesizer>();
  Ticket ticket;
  bool before = true, after = false;
  model->on_batch = [&](auto windows) {
    before = windows[0]->cancelled->load();
    ticket.cancelled->store(true);
    after = windows[0]->cancelled->load();
  };
  ASSERT_THAT(batcher->Submit(ticket.Job(model)), IsOk());
  EXPECT_THAT(ticket.outcome.get().result, IsOk());
  EXPECT_FALSE(before);
  EXPECT_TRUE(after);
}

// Keeps the timings of the second window that it is told of.
class TimingsObserver final : public WindowObserver {
 public:
  void BatchFinished(const WindowTimings&) override {}
  void WindowFinished(Priority, const WindowTimings& timings) override {
    if (++seen_ == 2) second_.set_value(timings);
  }
  WindowTimings WaitForSecond() { return second_.get_future().get(); }

 private:
  std::atomic<int> seen_{0};
  std::promise<WindowTimings> second_;
};

TEST(BatcherTest, ReportsQueueAndComputeTime) {
  FakeClock clock;
  auto model = std::make_shared<FakeSynthesizer>();
  GatedModel gate;
  model->on_batch = [&](absl::Span<const engine::SynthesisWindow* const>) {
    clock.Advance(milliseconds(250));
  };
  TimingsObserver observer;
  const auto batcher = MakeBatcher({1, 4, {4}}, clock, &observer);
  Ticket running, measured;
  ASSERT_THAT(batcher->Submit(running.Job(gate.get())), IsOk());
  gate.WaitUntilStarted(1);
  ASSERT_THAT(batcher->Submit(measured.Job(model)), IsOk());
  clock.Advance(milliseconds(125));
  gate.Open();
  const WindowTimings timings = measured.outcome.get().timings;
  EXPECT_DOUBLE_EQ(timings.queue_seconds, 0.125);
  EXPECT_DOUBLE_EQ(timings.compute_seconds, 0.25);
  EXPECT_DOUBLE_EQ(observer.WaitForSecond().compute_seconds, 0.25);
}

// A worker that is held up, so that what comes meanwhile waits for it.
class HeldWorker {
 public:
  explicit HeldWorker(WindowScheduler& batcher) {
    EXPECT_THAT(batcher.Submit(ticket_.Job(gate_.get())), IsOk());
    gate_.WaitUntilStarted(1);
  }
  ~HeldWorker() {
    Release();
    ticket_.outcome.wait();
  }
  void Release() { gate_.Open(); }

 private:
  GatedModel gate_;
  Ticket ticket_;
};

TEST(BatcherTest, GivesEveryCallItsOwnResult) {
  const auto batcher = MakeBatcher({1, 8, {4}}, common::Clock::Real());
  const auto model = std::make_shared<FakeSynthesizer>();
  HeldWorker held(*batcher);
  std::vector<Ticket> tickets(4);
  for (int i = 0; i < 4; ++i) {
    WindowJob job = tickets[static_cast<std::size_t>(i)].Job(model);
    job.window.leader = motion::Poses(2 + i, 15);
    job.window.labels.assign(6 * static_cast<std::size_t>(2 + i), 0.0F);
    ASSERT_THAT(batcher->Submit(std::move(job)), IsOk());
  }
  held.Release();
  for (int i = 0; i < 4; ++i) {
    const WindowOutcome outcome = tickets[static_cast<std::size_t>(i)].outcome.get();
    ASSERT_THAT(outcome.result, IsOk());
    EXPECT_EQ(outcome.result->frame_count(), 2 + i);
    EXPECT_EQ(outcome.timings.batch_size, 4);
  }
}

TEST(BatcherTest, RejectsACallThatWouldStartTooLate) {
  FakeClock clock;
  const auto slow = std::make_shared<FakeSynthesizer>();
  slow->on_batch = [&](absl::Span<const engine::SynthesisWindow* const>) {
    clock.Advance(milliseconds(250));
  };
  const auto batcher = MakeBatcher({1, 8, {4}}, clock);
  Ticket teaches, waits, too_late, in_time, goes_on;
  ASSERT_THAT(batcher->Submit(teaches.Job(slow)), IsOk());
  ASSERT_THAT(teaches.outcome.get().result, IsOk());
  HeldWorker held(*batcher);
  ASSERT_THAT(batcher->Submit(waits.Job(slow)), IsOk());
  const auto due = [&](const Ticket& ticket, milliseconds left) {
    WindowJob job = ticket.Job(slow);
    job.deadline = clock.Now() + left;
    return job;
  };
  // A quarter of a second for the one that waits, and one for its own.
  EXPECT_THAT(batcher->Submit(due(too_late, milliseconds(490))),
              StatusIs(kResourceExhausted, HasSubstr("the queue is too long")));
  EXPECT_THAT(batcher->Submit(due(in_time, milliseconds(510))), IsOk());
  WindowJob next = due(goes_on, milliseconds(490));
  next.continues_call = true;
  EXPECT_THAT(batcher->Submit(std::move(next)), IsOk()) << "a call that has begun is not refused";
}

TEST(BatcherTest, FailedWindowDoesNotFailItsBatch) {
  for (const bool throws : {false, true}) {
    const auto batcher = MakeBatcher({1, 8, {4}}, common::Clock::Real());
    const auto model = std::make_shared<FakeSynthesizer>();
    model->window_status = [&](const engine::SynthesisWindow& window) -> absl::Status {
      if (window.options.sampling.seed != 3) return absl::OkStatus();
      if (throws) throw std::runtime_error("three is too much");
      return absl::InternalError("three is too much");
    };
    HeldWorker held(*batcher);
    Ticket first, broken, last;
    ASSERT_THAT(batcher->Submit(first.Job(model)), IsOk());
    WindowJob job = broken.Job(model);
    job.window.options.sampling.seed = 3;
    ASSERT_THAT(batcher->Submit(std::move(job)), IsOk());
    ASSERT_THAT(batcher->Submit(last.Job(model)), IsOk());
    held.Release();
    const WindowOutcome outcome = first.outcome.get();
    EXPECT_THAT(outcome.result, IsOk());
    EXPECT_EQ(outcome.timings.batch_size, 3);
    EXPECT_THAT(broken.outcome.get().result, StatusIs(kInternal, HasSubstr("three is too much")));
    EXPECT_THAT(last.outcome.get().result, IsOk());
  }
}

// Answers no window of a batch.
class SilentModel final : public engine::Synthesizer {
 public:
  const engine::ModelDescription& description() const override { return description_; }
  std::vector<engine::WindowResult> Synthesize(
      absl::Span<const engine::SynthesisWindow* const>) const override {
    return {};
  }

 private:
  const engine::ModelDescription description_ = FakeDescription();
};

TEST(BatcherTest, SurvivesAModelThatGivesTooFewResults) {
  const auto batcher = MakeBatcher({1, 4, {4}}, common::Clock::Real());
  Ticket ticket;
  ASSERT_THAT(batcher->Submit(ticket.Job(std::make_shared<SilentModel>())), IsOk());
  EXPECT_THAT(ticket.outcome.get().result,
              StatusIs(kInternal, HasSubstr("expected results for 1 windows, got 0")));
}

TEST(BatcherTest, ShutdownFinishesRunningBatchesAndRejectsWaitingWindows) {
  GatedModel model;
  Ticket running, waiting;
  std::thread opener;
  {
    const auto batcher = MakeBatcher({1, 4, {4}}, common::Clock::Real());
    ASSERT_THAT(batcher->Submit(running.Job(model.get())), IsOk());
    model.WaitUntilStarted(1);
    ASSERT_THAT(batcher->Submit(waiting.Job(model.get())), IsOk());
    // Opens only once the batcher refuses, which is when its destructor has begun.
    opener = std::thread([&] {
      Ticket probe;
      while (batcher->Submit(probe.Job(model.get())).code() != kUnavailable) probe = Ticket();
      model.Open();
    });
  }
  opener.join();
  EXPECT_THAT(running.outcome.get().result, IsOk());
  EXPECT_THAT(waiting.outcome.get().result, StatusIs(kUnavailable, HasSubstr("shutting down")));
  EXPECT_EQ(model.started(), 1);
}

TEST(BatcherTest, AnswersEveryWindowOnceUnderLoad) {
  constexpr int kThreads = 4;
  constexpr int kJobs = 50;
  const auto model = std::make_shared<FakeSynthesizer>();
  std::atomic<int> answered{0};
  std::atomic<int> refused{0};
  {
    const auto batcher = MakeBatcher({3, 16, {4}}, common::Clock::Real());
    std::vector<std::thread> callers;
    callers.reserve(kThreads);
    for (int t = 0; t < kThreads; ++t) {
      callers.emplace_back([&, t] {
        for (int i = 0; i < kJobs; ++i) {
          Ticket ticket;
          WindowJob job = ticket.Job(model);
          job.priority = i % 2 == 0 ? Priority::kBulk : Priority::kInteractive;
          job.done = [&](const WindowOutcome&) { ++answered; };
          if (!batcher->Submit(std::move(job)).ok()) ++refused;
          if ((i + t) % 5 == 0) ticket.cancelled->store(true);
        }
      });
    }
    for (std::thread& caller : callers) caller.join();
  }
  EXPECT_EQ(answered + refused, kThreads * kJobs);
}

}  // namespace
}  // namespace duet::server::batching
