#ifndef DUET_SERVER_BATCHING_WORKER_POOL_H_
#define DUET_SERVER_BATCHING_WORKER_POOL_H_

#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

#include "server/batching/window_queue.h"
#include "server/batching/window_scheduler.h"
#include "server/common/clock.h"
#include "server/common/mutex.h"

namespace duet::server::batching {

struct WorkerPoolOptions {
  int workers = 1;
  int max_queued_windows = 64;
};

// A WindowScheduler with a fixed number of threads, each evaluating one window at a time.
//
// Threads: safe to call concurrently. Owns the only threads that run a model.
class WorkerPool final : public WindowScheduler {
 public:
  // Told of every window that left the queue, on a worker, under no lock.
  using Observer = std::function<void(Priority, const WindowTimings&)>;

  WorkerPool(const WorkerPoolOptions& options, const common::Clock& clock,
             Observer observer = nullptr);
  // Finishes the windows that have started; those still waiting get UNAVAILABLE.
  ~WorkerPool() override;

  absl::Status Submit(WindowJob job) override;

  std::size_t queued_windows() const;

 private:
  void Work();
  // Waits for the next window; false when there will be none.
  bool Next(QueuedWindow* window, bool* stopping);
  void Run(QueuedWindow window, bool stopping) const;

  const common::Clock& clock_;
  const Observer observer_;
  mutable common::Mutex mutex_;
  common::CondVar changed_;
  WindowQueue queue_ DUET_GUARDED_BY(mutex_);
  bool stopping_ DUET_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> workers_;
};

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_WORKER_POOL_H_
