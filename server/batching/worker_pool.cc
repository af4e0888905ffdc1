#include "server/batching/worker_pool.h"

#include <cstddef>
#include <exception>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "server/batching/window_queue.h"
#include "server/common/mutex.h"

namespace duet::server::batching {
namespace {

// Why a window must not start, or OK.
absl::Status MayStart(const WindowJob& job, common::TimePoint now, bool stopping) {
  if (job.cancelled->load(std::memory_order_acquire)) {
    return absl::CancelledError("the call was cancelled before this window started");
  }
  if (now >= job.deadline) {
    return absl::DeadlineExceededError("the deadline passed before this window started");
  }
  if (stopping) return absl::UnavailableError("the server is shutting down");
  return absl::OkStatus();
}

// A model reports failures as a status; whatever else escapes it must not take the server down.
engine::WindowResult Evaluate(const WindowJob& job) {
  try {
    const engine::SynthesisWindow* windows[] = {&job.window};
    std::vector<engine::WindowResult> results = job.model->Synthesize(windows);
    if (results.size() == 1) return std::move(results.front());
    return absl::InternalError("the model gave " + std::to_string(results.size()) +
                               " results for 1 window");
  } catch (const std::exception& error) {
    return absl::InternalError(std::string("the model threw: ") + error.what());
  } catch (...) {
    return absl::InternalError("the model threw something that is no exception");
  }
}

class WorkerPool final : public WindowScheduler {
 public:
  WorkerPool(const WorkerPoolOptions& options, const common::Clock& clock,
             WindowObserver* observer);
  ~WorkerPool() override;

  absl::Status Submit(WindowJob job) override;
  std::size_t queued_windows() const override;

 private:
  void Work();
  // Waits for the next window; false when there will be none.
  bool Next(QueuedWindow* window, bool* stopping);
  void Run(QueuedWindow window, bool stopping) const;

  const common::Clock& clock_;
  WindowObserver* const observer_;
  mutable common::Mutex mutex_;
  common::CondVar changed_;
  WindowQueue queue_ DUET_GUARDED_BY(mutex_);
  bool stopping_ DUET_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> workers_;
};

WorkerPool::WorkerPool(const WorkerPoolOptions& options, const common::Clock& clock,
                       WindowObserver* observer)
    : clock_(clock),
      observer_(observer),
      queue_(static_cast<std::size_t>(options.max_queued_windows)) {
  for (int i = 0; i < options.workers; ++i) workers_.emplace_back([this] { Work(); });
}

WorkerPool::~WorkerPool() {
  {
    common::MutexLock lock(mutex_);
    stopping_ = true;
  }
  changed_.NotifyAll();
  for (std::thread& worker : workers_) worker.join();
}

absl::Status WorkerPool::Submit(WindowJob job) {
  {
    common::MutexLock lock(mutex_);
    if (stopping_) return absl::UnavailableError("the server is shutting down");
    if (!queue_.HasRoomFor(job)) {
      return absl::ResourceExhaustedError("the queue is full: " + std::to_string(queue_.size()) +
                                          " windows wait, at most " +
                                          std::to_string(queue_.capacity()) + " may");
    }
    queue_.Push({std::move(job), clock_.Now()});
  }
  changed_.NotifyOne();
  return absl::OkStatus();
}

std::size_t WorkerPool::queued_windows() const {
  common::MutexLock lock(mutex_);
  return queue_.size();
}

void WorkerPool::Work() {
  QueuedWindow window;
  bool stopping = false;
  while (Next(&window, &stopping)) Run(std::move(window), stopping);
}

bool WorkerPool::Next(QueuedWindow* window, bool* stopping) {
  common::MutexLock lock(mutex_);
  while (queue_.size() == 0 && !stopping_) changed_.Wait(mutex_);
  std::optional<QueuedWindow> next = queue_.Pop();
  if (!next.has_value()) return false;
  *window = *std::move(next);
  *stopping = stopping_;
  return true;
}

// By value, so that the model is let go of as soon as its window is done.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
void WorkerPool::Run(QueuedWindow window, bool stopping) const {
  const WindowJob& job = window.job;
  const common::TimePoint begin = clock_.Now();
  absl::Status may_start = MayStart(job, begin, stopping);
  const bool starts = may_start.ok();
  WindowOutcome outcome{starts ? Evaluate(job) : engine::WindowResult(std::move(may_start)), {}};
  outcome.timings.queue_seconds = common::SecondsBetween(window.queued_at, begin);
  if (starts) {
    outcome.timings.compute_seconds = common::SecondsBetween(begin, clock_.Now());
    outcome.timings.batch_size = 1;
  }
  if (observer_ != nullptr) observer_->WindowFinished(job.priority, outcome.timings);
  job.done(std::move(outcome));
}

}  // namespace

std::unique_ptr<WindowScheduler> MakeWorkerPool(const WorkerPoolOptions& options,
                                                const common::Clock& clock,
                                                WindowObserver* observer) {
  return std::make_unique<WorkerPool>(options, clock, observer);
}

}  // namespace duet::server::batching
