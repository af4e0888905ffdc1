// The queue under load, in simulated time: what callers see when workers ask it what to do.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/batching/window_queue.h"
#include "tests/support/fake_synthesizer.h"

namespace duet::server::batching {
namespace {

using common::TimePoint;
using std::chrono::milliseconds;

constexpr TimePoint kStart(std::chrono::hours(1));
constexpr int kFrames = 45;
constexpr int kTenMinutes = 240;  // windows

TimePoint After(TimePoint start, double seconds) { return start + common::Seconds(seconds); }

// What an engine takes.
struct Engine {
  double batch_seconds = 0;
  double window_seconds = 0;
  // `windows`: each counted once for each candidate.
  double Seconds(int windows) const { return batch_seconds + window_seconds * windows; }
};
constexpr Engine kFast = {0.001, 0.0007};
constexpr Engine kSlow = {0.008, 0.005};

// A scheduler with two workers whose threads are events.
class Simulation {
 public:
  Simulation(const Engine& engine, int max_windows)
      : engine_(engine), queue_({kWorkers, 64, {max_windows}}) {}

  TimePoint now() const { return now_; }
  void At(TimePoint time, std::function<void()> event) { events_.emplace(time, std::move(event)); }
  void RunUntil(TimePoint end) {
    while (!events_.empty() && events_.begin()->first < end) {
      now_ = events_.begin()->first;
      const std::function<void()> event = std::move(events_.begin()->second);
      events_.erase(events_.begin());
      event();
    }
  }
  // A window of a call of so many; `done` gets whether it was evaluated.
  void Submit(int call_windows, bool continues_call, Priority priority, TimePoint deadline,
              const std::function<void(bool)>& done) {
    WindowJob job;
    job.priority = priority;
    job.deadline = deadline;
    job.call_windows = call_windows;
    job.continues_call = continues_call;
    Submit(std::move(job), done);
  }
  void Submit(WindowJob job, const std::function<void(bool)>& done) {
    job.model = model_;
    job.window.leader = motion::Poses(kFrames, 1);
    job.cancelled = never_;
    job.done = [done](const WindowOutcome& outcome) { done(outcome.result.ok()); };
    if (!queue_.HasRoomFor(job, now_)) return done(false);
    if (!job.continues_call && !queue_.ComesInTime(job, now_)) return done(false);
    queue_.Push(std::move(job), now_);
    LetWorkersAsk();
  }

 private:
  static constexpr int kWorkers = 2;

  void LetWorkersAsk() {
    while (busy_ < kWorkers) {
      Turn turn = queue_.Next(now_);
      if (!turn.batch.windows.empty()) Evaluate(std::move(turn.batch));
      for (DroppedWindow& dropped : turn.dropped) dropped.window.job.done({dropped.reason, {}});
      if (turn.batch.windows.empty()) return;
    }
  }
  void Evaluate(Batch batch) {
    ++busy_;
    const TimePoint end = After(now_, engine_.Seconds(batch.Candidates()));
    At(end, [this, batch = std::move(batch)] {
      queue_.Finished(batch, now_);
      --busy_;
      for (const QueuedWindow& window : batch.windows) window.job.done({motion::Poses(), {}});
      LetWorkersAsk();
    });
  }

  const Engine engine_;
  WindowQueue queue_;
  const std::shared_ptr<const engine::Synthesizer> model_ =
      std::make_shared<test::FakeSynthesizer>(test::SamplingDescription());
  const std::shared_ptr<std::atomic<bool>> never_ = std::make_shared<std::atomic<bool>>(false);
  std::multimap<TimePoint, std::function<void()>> events_;
  TimePoint now_ = kStart;
  int busy_ = 0;
};

// Calls of one window answered in time, a second, when they come at a steady rate for ten seconds.
// An answer is on its way for 3 ms.
double Goodput(const Engine& engine, double calls_per_second, double deadline_seconds) {
  constexpr double kSeconds = 10;
  Simulation simulation(engine, 16);
  int in_time = 0;
  for (int i = 0; i < static_cast<int>(kSeconds * calls_per_second); ++i) {
    simulation.At(After(kStart, i / calls_per_second), [&, deadline_seconds] {
      const TimePoint deadline = After(simulation.now(), deadline_seconds);
      simulation.Submit(1, false, Priority::kInteractive, deadline, [&, deadline](bool evaluated) {
        in_time += evaluated && simulation.now() + milliseconds(3) <= deadline ? 1 : 0;
      });
    });
  }
  simulation.RunUntil(After(kStart, kSeconds));
  return in_time / kSeconds;
}

TEST(SimulatedLoadTest, GoodputHoldsUnderTightDeadlines) {
  for (const Engine& engine : {kFast, kSlow}) {
    const double capacity = 2 * 16 / engine.Seconds(16);
    for (const double deadline : {10.0, 1.0, 0.3, 0.15, 0.1}) {
      EXPECT_GT(Goodput(engine, 2 * capacity, deadline), 0.85 * capacity)
          << "deadline " << deadline << " s, a batch takes " << engine.Seconds(16) << " s";
    }
    for (const double deadline : {1.0, 0.15}) {
      EXPECT_GT(Goodput(engine, 0.9 * capacity, deadline), 0.99 * 0.9 * capacity)
          << "below capacity every call meets its deadline of " << deadline << " s";
    }
  }
}

// A call that asks for one of so many windows after the other, and has done so for a while.
void KeepAsking(Simulation& simulation, int call_windows, Priority priority, int* evaluated) {
  simulation.Submit(call_windows, true, priority, TimePoint::max(),
                    [&simulation, call_windows, priority, evaluated](bool) {
                      ++*evaluated;
                      KeepAsking(simulation, call_windows, priority, evaluated);
                    });
}

// How long calls of one window wait, in the median, while so many others ask for long clips.
double MedianWait(const Engine& engine, int long_calls, Priority priority) {
  constexpr int kCalls = 200;
  Simulation simulation(engine, 16);
  int others = 0;
  for (int i = 0; i < long_calls; ++i) {
    // They are under way when the first short call comes.
    simulation.At(kStart + i * milliseconds(1),
                  [&] { KeepAsking(simulation, kTenMinutes, priority, &others); });
  }
  std::vector<double> waits;
  for (int i = 0; i < kCalls; ++i) {
    simulation.At(After(kStart, 1 + 0.0371 * i), [&] {
      simulation.Submit(1, false, Priority::kInteractive, TimePoint::max(),
                        [&, start = simulation.now()](bool) {
                          waits.push_back(common::SecondsBetween(start, simulation.now()));
                        });
    });
  }
  simulation.RunUntil(After(kStart, 10));
  EXPECT_EQ(waits.size(), static_cast<std::size_t>(kCalls)) << "every short call is admitted";
  std::sort(waits.begin(), waits.end());
  return waits[waits.size() / 2];
}

TEST(SimulatedLoadTest, LongCallsDoNotBlockShortOnes) {
  for (const Engine& engine : {kFast, kSlow}) {
    const double idle = MedianWait(engine, 0, Priority::kInteractive);
    EXPECT_DOUBLE_EQ(idle, engine.Seconds(1));
    EXPECT_LT(MedianWait(engine, 66, Priority::kInteractive), 3 * idle);
    EXPECT_LT(MedianWait(engine, 66, Priority::kBulk), 3 * idle);
  }
}

TEST(SimulatedLoadTest, NoLaneStarvesBesideEndlessShortCalls) {
  Simulation simulation(kFast, 16);
  int bulk = 0, long_calls = 0, short_calls = 0;
  for (int i = 0; i < 20; ++i) {
    KeepAsking(simulation, kTenMinutes, Priority::kBulk, &bulk);
    KeepAsking(simulation, kTenMinutes, Priority::kInteractive, &long_calls);
  }
  std::function<void(bool)> again = [&](bool evaluated) {
    short_calls += evaluated ? 1 : 0;
    simulation.Submit(1, false, Priority::kInteractive, TimePoint::max(), again);
  };
  for (int i = 0; i < 60; ++i) again(false);
  simulation.RunUntil(After(kStart, 5));
  const double all = bulk + long_calls + short_calls;
  EXPECT_NEAR(bulk / all, 1.0 / 8, 0.02);
  EXPECT_NEAR(long_calls / (all - bulk), 1.0 / 8, 0.02);
}

// A live session: a window for each frame at 30 Hz, or as soon as the one before is answered.
class Session {
 public:
  Session(Simulation& simulation, std::string client, int candidates, double first_seconds)
      : simulation_(simulation), client_(std::move(client)), candidates_(candidates) {
    simulation_.At(After(kStart, first_seconds), [this] { Ask(); });
  }
  // Of the slowest answer.
  double longest_seconds() const { return longest_seconds_; }

 private:
  static constexpr double kFrameSeconds = 1.0 / 30;

  void Ask() {
    WindowJob job;
    job.window.options.sampling.candidates = candidates_;
    job.client = client_;
    job.continues_call = true;
    job.due = After(simulation_.now(), kFrameSeconds);
    simulation_.Submit(std::move(job), [this, begin = simulation_.now()](bool) {
      longest_seconds_ =
          std::max(longest_seconds_, common::SecondsBetween(begin, simulation_.now()));
      simulation_.At(std::max(simulation_.now(), After(begin, kFrameSeconds)), [this] { Ask(); });
    });
  }

  Simulation& simulation_;
  const std::string client_;
  const int candidates_;
  double longest_seconds_ = 0;
};

// The longest that a client waits for an answer beside eight live sessions of another one.
struct Longest {
  double clip_seconds = 0;  // of one window
  double live_seconds = 0;  // of a frame of its own live session
};

Longest BesideSessions(int candidates) {
  Simulation simulation(kFast, 16);
  std::vector<std::unique_ptr<Session>> others;
  for (int i = 0; i < 8; ++i) {
    others.push_back(std::make_unique<Session>(simulation, "other", candidates, 0.0041 * i));
  }
  Session own(simulation, "own", 1, 0.5);
  constexpr int kClips = 200;
  Longest longest;
  int answered = 0;
  for (int i = 0; i < kClips; ++i) {
    simulation.At(After(kStart, 1 + 0.0371 * i), [&] {
      WindowJob job;
      job.client = "own";
      simulation.Submit(std::move(job), [&, begin = simulation.now()](bool) {
        longest.clip_seconds =
            std::max(longest.clip_seconds, common::SecondsBetween(begin, simulation.now()));
        ++answered;
      });
    });
  }
  simulation.RunUntil(After(kStart, 10));
  EXPECT_EQ(answered, kClips);
  longest.live_seconds = own.longest_seconds();
  return longest;
}

TEST(SimulatedLoadTest, CandidatesOfOneClientDoNotDelayAnother) {
  for (const int candidates : {4, 8, 16}) {
    const Longest longest = BesideSessions(candidates);
    EXPECT_LT(longest.clip_seconds, 3 * kFast.Seconds(1)) << candidates;
    // The first frame of the session finds both workers busy.
    EXPECT_LT(longest.live_seconds, kFast.Seconds(16) + kFast.Seconds(2)) << candidates;
    EXPECT_LT(longest.live_seconds, 1.0 / 30) << "no frame is skipped";
  }
}

}  // namespace
}  // namespace duet::server::batching
