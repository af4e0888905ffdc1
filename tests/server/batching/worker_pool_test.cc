#include "server/batching/worker_pool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/support/fake_clock.h"
#include "tests/server/support/gated_model.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/sample_motion.h"
#include "tests/support/status_matchers.h"

namespace duet::server::batching {
namespace {

using test::FakeAnswer;
using test::FakeClock;
using test::FakeDescription;
using test::FakeSynthesizer;
using test::GatedModel;
using test::IsOk;
using test::StatusIs;
using test::SwayingMotion;

using ::testing::HasSubstr;

constexpr auto kCancelled = absl::StatusCode::kCancelled;
constexpr auto kDeadlineExceeded = absl::StatusCode::kDeadlineExceeded;
constexpr auto kInternal = absl::StatusCode::kInternal;
constexpr auto kResourceExhausted = absl::StatusCode::kResourceExhausted;
constexpr auto kUnavailable = absl::StatusCode::kUnavailable;

// A job and its outcome.
struct Ticket {
  std::shared_ptr<std::atomic<bool>> cancelled = std::make_shared<std::atomic<bool>>(false);
  std::shared_ptr<std::promise<WindowOutcome>> promise =
      std::make_shared<std::promise<WindowOutcome>>();
  std::future<WindowOutcome> outcome = promise->get_future();

  WindowJob Job(std::shared_ptr<const engine::Synthesizer> model) {
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

TEST(WorkerPoolTest, EvaluatesAWindow) {
  const auto pool = MakeWorkerPool({1, 4}, common::Clock::Real());
  Ticket ticket;
  ASSERT_THAT(pool->Submit(ticket.Job(std::make_shared<FakeSynthesizer>())), IsOk());
  const WindowOutcome outcome = ticket.outcome.get();
  ASSERT_THAT(outcome.result, IsOk());
  const motion::Vec3 expected =
      FakeAnswer(SwayingMotion(4, 15).at(0, 7), std::vector<float>(6, 0.0F));
  EXPECT_EQ(outcome.result->at(0, 7), expected);
  EXPECT_EQ(outcome.timings.batch_size, 1);
}

TEST(WorkerPoolTest, EvaluatesAsManyWindowsAtOnceAsThereAreWorkers) {
  const auto pool = MakeWorkerPool({2, 4}, common::Clock::Real());
  GatedModel model;
  Ticket first, second;
  ASSERT_THAT(pool->Submit(first.Job(model.get())), IsOk());
  ASSERT_THAT(pool->Submit(second.Job(model.get())), IsOk());
  model.WaitUntilStarted(2);  // would wait for ever with one worker
  model.Open();
  EXPECT_THAT(first.outcome.get().result, IsOk());
  EXPECT_THAT(second.outcome.get().result, IsOk());
}

TEST(WorkerPoolTest, RefusesANewCallWhenTheQueueIsFull) {
  GatedModel model;
  const auto pool = MakeWorkerPool({1, 1}, common::Clock::Real());
  Ticket running, waiting, refused, continued;
  ASSERT_THAT(pool->Submit(running.Job(model.get())), IsOk());
  model.WaitUntilStarted(1);
  ASSERT_THAT(pool->Submit(waiting.Job(model.get())), IsOk());
  EXPECT_EQ(pool->queued_windows(), 1u);
  EXPECT_THAT(pool->Submit(refused.Job(model.get())),
              StatusIs(kResourceExhausted, HasSubstr("1 windows wait, at most 1 may")));
  WindowJob next = continued.Job(model.get());
  next.continues_call = true;
  EXPECT_THAT(pool->Submit(std::move(next)), IsOk());
  model.Open();
  EXPECT_THAT(waiting.outcome.get().result, IsOk());
  EXPECT_THAT(continued.outcome.get().result, IsOk());
}

TEST(WorkerPoolTest, NeverStartsACancelledWindow) {
  GatedModel model;
  const auto pool = MakeWorkerPool({1, 4}, common::Clock::Real());
  Ticket running, cancelled;
  ASSERT_THAT(pool->Submit(running.Job(model.get())), IsOk());
  model.WaitUntilStarted(1);
  ASSERT_THAT(pool->Submit(cancelled.Job(model.get())), IsOk());
  cancelled.cancelled->store(true);
  model.Open();
  const WindowOutcome outcome = cancelled.outcome.get();
  EXPECT_THAT(outcome.result, StatusIs(kCancelled, HasSubstr("before this window started")));
  EXPECT_EQ(outcome.timings.batch_size, 0);
  EXPECT_EQ(model.started(), 1);
}

TEST(WorkerPoolTest, NeverStartsAnExpiredWindow) {
  FakeClock clock;
  GatedModel model;
  const auto pool = MakeWorkerPool({1, 4}, clock);
  Ticket running, expired;
  ASSERT_THAT(pool->Submit(running.Job(model.get())), IsOk());
  model.WaitUntilStarted(1);
  WindowJob job = expired.Job(model.get());
  job.deadline = clock.Now() + std::chrono::milliseconds(100);
  ASSERT_THAT(pool->Submit(std::move(job)), IsOk());
  clock.Advance(std::chrono::milliseconds(100));
  model.Open();
  EXPECT_THAT(expired.outcome.get().result,
              StatusIs(kDeadlineExceeded, HasSubstr("before this window started")));
  EXPECT_EQ(model.started(), 1);
}

TEST(WorkerPoolTest, StartsInteractiveWindowsFirst) {
  GatedModel gate;
  const auto pool = MakeWorkerPool({1, 8}, common::Clock::Real());
  Ticket running, bulk, interactive;
  ASSERT_THAT(pool->Submit(running.Job(gate.get())), IsOk());
  gate.WaitUntilStarted(1);
  std::vector<std::string> order;  // written by the one worker, read after both outcomes
  const auto naming = [&order](const char* name) {
    auto model = std::make_shared<FakeSynthesizer>();
    model->on_batch = [&order, name](absl::Span<const engine::SynthesisWindow* const>) {
      order.push_back(name);
    };
    return model;
  };
  WindowJob bulk_job = bulk.Job(naming("bulk"));
  bulk_job.priority = Priority::kBulk;
  ASSERT_THAT(pool->Submit(std::move(bulk_job)), IsOk());
  ASSERT_THAT(pool->Submit(interactive.Job(naming("interactive"))), IsOk());
  gate.Open();
  bulk.outcome.wait();
  interactive.outcome.wait();
  EXPECT_THAT(order, testing::ElementsAre("interactive", "bulk"));
}

// Keeps the timings of the second window that it is told of.
class TimingsObserver final : public WindowObserver {
 public:
  void WindowFinished(Priority, const WindowTimings& timings) override {
    if (++seen_ == 2) second_.set_value(timings);
  }
  WindowTimings WaitForSecond() { return second_.get_future().get(); }

 private:
  std::atomic<int> seen_{0};
  std::promise<WindowTimings> second_;
};

TEST(WorkerPoolTest, SaysWhereTheTimeWent) {
  FakeClock clock;
  auto model = std::make_shared<FakeSynthesizer>();
  GatedModel gate;
  model->on_batch = [&](absl::Span<const engine::SynthesisWindow* const>) {
    clock.Advance(std::chrono::milliseconds(250));
  };
  TimingsObserver observer;
  const auto pool = MakeWorkerPool({1, 4}, clock, &observer);
  Ticket running, measured;
  ASSERT_THAT(pool->Submit(running.Job(gate.get())), IsOk());
  gate.WaitUntilStarted(1);
  ASSERT_THAT(pool->Submit(measured.Job(model)), IsOk());
  clock.Advance(std::chrono::milliseconds(125));
  gate.Open();
  const WindowTimings timings = measured.outcome.get().timings;
  EXPECT_DOUBLE_EQ(timings.queue_seconds, 0.125);
  EXPECT_DOUBLE_EQ(timings.compute_seconds, 0.25);
  EXPECT_DOUBLE_EQ(observer.WaitForSecond().compute_seconds, 0.25);
}

// Fails in ways that the interface does not allow.
class BrokenModel final : public engine::Synthesizer {
 public:
  explicit BrokenModel(bool throws) : throws_(throws) {}
  const engine::ModelDescription& description() const override { return description_; }
  std::vector<engine::WindowResult> Synthesize(
      absl::Span<const engine::SynthesisWindow* const>) const override {
    if (throws_) throw std::runtime_error("out of luck");
    return {};
  }

 private:
  const bool throws_;
  const engine::ModelDescription description_ = FakeDescription();
};

TEST(WorkerPoolTest, SurvivesAModelThatThrows) {
  const auto pool = MakeWorkerPool({1, 4}, common::Clock::Real());
  Ticket broken, sound;
  ASSERT_THAT(pool->Submit(broken.Job(std::make_shared<BrokenModel>(true))), IsOk());
  EXPECT_THAT(broken.outcome.get().result, StatusIs(kInternal, HasSubstr("out of luck")));
  ASSERT_THAT(pool->Submit(sound.Job(std::make_shared<FakeSynthesizer>())), IsOk());
  EXPECT_THAT(sound.outcome.get().result, IsOk());
}

TEST(WorkerPoolTest, SurvivesAModelThatGivesTooFewResults) {
  const auto pool = MakeWorkerPool({1, 4}, common::Clock::Real());
  Ticket ticket;
  ASSERT_THAT(pool->Submit(ticket.Job(std::make_shared<BrokenModel>(false))), IsOk());
  EXPECT_THAT(ticket.outcome.get().result,
              StatusIs(kInternal, HasSubstr("0 results for 1 window")));
}

TEST(WorkerPoolTest, ShutdownFinishesWhatRunsAndAnswersWhatWaits) {
  GatedModel model;
  Ticket running, waiting;
  std::thread opener;
  {
    const auto pool = MakeWorkerPool({1, 4}, common::Clock::Real());
    ASSERT_THAT(pool->Submit(running.Job(model.get())), IsOk());
    model.WaitUntilStarted(1);
    ASSERT_THAT(pool->Submit(waiting.Job(model.get())), IsOk());
    // Opens only once the pool refuses, which is when its destructor has begun.
    opener = std::thread([&] {
      Ticket probe;
      while (pool->Submit(probe.Job(model.get())).code() != kUnavailable) probe = Ticket();
      model.Open();
    });
  }
  opener.join();
  EXPECT_THAT(running.outcome.get().result, IsOk());
  EXPECT_THAT(waiting.outcome.get().result, StatusIs(kUnavailable, HasSubstr("shutting down")));
  EXPECT_EQ(model.started(), 1);
}

TEST(WorkerPoolTest, AnswersEveryWindowOnceUnderLoad) {
  constexpr int kThreads = 4;
  constexpr int kJobs = 50;
  const auto model = std::make_shared<FakeSynthesizer>();
  std::atomic<int> answered{0};
  std::atomic<int> refused{0};
  {
    const auto pool = MakeWorkerPool({3, 16}, common::Clock::Real());
    std::vector<std::thread> callers;
    for (int t = 0; t < kThreads; ++t) {
      callers.emplace_back([&, t] {
        for (int i = 0; i < kJobs; ++i) {
          Ticket ticket;
          WindowJob job = ticket.Job(model);
          job.priority = i % 2 == 0 ? Priority::kBulk : Priority::kInteractive;
          job.done = [&](WindowOutcome) { ++answered; };
          if (!pool->Submit(std::move(job)).ok()) ++refused;
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
