#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "server/batching/window_queue.h"
#include "server/common/mutex.h"

namespace duet::server::batching {
namespace {

absl::Status ShuttingDown() { return absl::UnavailableError("the server is shutting down"); }

absl::Status QueueFull(std::size_t capacity) {
  return absl::ResourceExhaustedError("the queue is full: at most " + std::to_string(capacity) +
                                      " first windows of calls may wait, each counted once for "
                                      "each candidate, and no client's calls "
                                      "may fill all of it");
}

absl::Status QueueTooLong(const WindowJob& job, common::TimePoint now) {
  return absl::ResourceExhaustedError(
      "the queue is too long: by the time of its turn the deadline, " +
      std::to_string(common::SecondsBetween(now, job.deadline)) +
      " s away, would be too near for an answer");
}

using Windows = absl::Span<const engine::SynthesisWindow* const>;
using Results = std::vector<engine::WindowResult>;

// Models report failures as a status. An exception from a model must not end the server.
absl::StatusOr<Results> EvaluateTogether(const engine::Synthesizer& model, Windows windows) {
  try {
    Results results = model.Synthesize(windows);
    if (results.size() == windows.size()) return results;
    return absl::InternalError("model: expected results for " + std::to_string(windows.size()) +
                               " windows, got " + std::to_string(results.size()));
  } catch (const std::exception& error) {
    return absl::InternalError(std::string("the model threw: ") + error.what());
  } catch (...) {
    return absl::InternalError("the model threw an object that is not a std::exception");
  }
}

// If a whole batch fails, any of its windows may be the cause. Each window is retried by itself, so
// that one failing window does not affect the others.
Results Evaluate(const Batch& batch) {
  const engine::Synthesizer& model = *batch.windows[0].job.model;
  std::vector<const engine::SynthesisWindow*> windows;
  for (const QueuedWindow& queued : batch.windows) windows.push_back(&queued.job.window);
  absl::StatusOr<Results> together = EvaluateTogether(model, windows);
  if (together.ok()) return *std::move(together);
  if (windows.size() == 1) return {together.status()};
  Results each;
  for (const engine::SynthesisWindow* const& window : windows) {
    absl::StatusOr<Results> alone = EvaluateTogether(model, absl::MakeConstSpan(&window, 1));
    each.push_back(alone.ok() ? std::move(alone->front()) : alone.status());
  }
  return each;
}

class Batcher final : public WindowScheduler {
 public:
  Batcher(const BatcherOptions& options, const common::Clock& clock, WindowObserver* observer)
      : clock_(clock), observer_(observer), queue_(options) {
    for (int i = 0; i < options.workers; ++i) workers_.emplace_back([this] { Work(); });
  }
  ~Batcher() override {
    {
      common::MutexLock lock(mutex_);
      stopping_ = true;
    }
    changed_.NotifyAll();
    for (std::thread& worker : workers_) worker.join();
  }

  absl::Status Submit(WindowJob job) override {
    job.window.cancelled = job.cancelled;  // the model checks it while it computes
    {
      common::MutexLock lock(mutex_);
      if (stopping_) return ShuttingDown();
      const common::TimePoint now = clock_.Now();
      if (!queue_.HasRoomFor(job, now)) return QueueFull(queue_.capacity());
      if (!job.continues_call && !queue_.ComesInTime(job, now)) return QueueTooLong(job, now);
      queue_.Push(std::move(job), now);
      CountQueue();
    }
    changed_.NotifyOne();
    return absl::OkStatus();
  }

  absl::Status CheckRoom(Priority priority, const std::string& client) const override {
    common::MutexLock lock(mutex_);
    if (stopping_) return ShuttingDown();
    return queue_.HasRoomFor(priority, client, clock_.Now()) ? absl::OkStatus()
                                                             : QueueFull(queue_.capacity());
  }

  std::size_t queued_windows() const override { return queued_; }

 private:
  void Work() {
    while (std::optional<Turn> turn = Next()) {
      for (DroppedWindow& dropped : turn->dropped) {
        WindowTimings timings;
        timings.queue_seconds = common::SecondsBetween(dropped.window.queued_at, clock_.Now());
        Answer(std::move(dropped.window), std::move(dropped.reason), timings);
      }
      if (!turn->batch.windows.empty()) Run(std::move(turn->batch));
    }
  }

  // Waits for work. Absent if there will be no more.
  std::optional<Turn> Next() {
    common::MutexLock lock(mutex_);
    while (true) {
      Turn turn;
      if (stopping_) {
        turn.dropped = queue_.DropAll(ShuttingDown(), clock_.Now());
        CountQueue();
        if (turn.dropped.empty()) return std::nullopt;
        return turn;
      }
      turn = queue_.Next(clock_.Now());
      CountQueue();
      if (!turn.dropped.empty() || !turn.batch.windows.empty()) {
        // The remaining windows may be for another free worker.
        if (queue_.size() > 0) changed_.NotifyOne();
        return turn;
      }
      WaitUntil(turn.look_again);
    }
  }

  void WaitUntil(common::TimePoint time) DUET_REQUIRES(mutex_) {
    if (time == common::TimePoint::max()) {
      changed_.Wait(mutex_);
    } else {
      changed_.WaitUntil(mutex_, std::chrono::steady_clock::now() + (time - clock_.Now()));
    }
  }

  // Call after every change of the queue.
  void CountQueue() DUET_REQUIRES(mutex_) { queued_ = queue_.candidates(); }

  // By value, so that the model is released as soon as its windows are done.
  // NOLINTNEXTLINE(performance-unnecessary-value-param)
  void Run(Batch batch) {
    std::vector<engine::WindowResult> results = Evaluate(batch);
    const common::TimePoint end = clock_.Now();
    {
      common::MutexLock lock(mutex_);
      queue_.Finished(batch, end);
    }
    WindowTimings timings;
    timings.compute_seconds = common::SecondsBetween(batch.started_at, end);
    timings.batch_size = batch.Candidates();
    if (observer_ != nullptr) observer_->BatchFinished(timings);
    for (std::size_t i = 0; i < batch.windows.size(); ++i) {
      QueuedWindow& window = batch.windows[i];
      timings.queue_seconds = common::SecondsBetween(window.queued_at, batch.started_at);
      timings.frames = window.frames;
      Answer(std::move(window), std::move(results[i]), timings);
    }
  }

  // By value, so that the job's resources are released as soon as it is done.
  // NOLINTNEXTLINE(performance-unnecessary-value-param)
  void Answer(QueuedWindow window, engine::WindowResult result, WindowTimings timings) const {
    if (observer_ != nullptr) observer_->WindowFinished(window.job.priority, timings);
    window.job.done({std::move(result), timings});
  }

  const common::Clock& clock_;
  WindowObserver* const observer_;
  mutable common::Mutex mutex_;
  common::CondVar changed_;
  WindowQueue queue_ DUET_GUARDED_BY(mutex_);
  std::atomic<std::size_t> queued_{0};  // candidates in queue_, readable without the lock
  bool stopping_ DUET_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> workers_;
};

}  // namespace

std::unique_ptr<WindowScheduler> MakeBatcher(const BatcherOptions& options,
                                             const common::Clock& clock, WindowObserver* observer) {
  return std::make_unique<Batcher>(options, clock, observer);
}

}  // namespace duet::server::batching
