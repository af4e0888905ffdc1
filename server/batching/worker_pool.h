#ifndef DUET_SERVER_BATCHING_WORKER_POOL_H_
#define DUET_SERVER_BATCHING_WORKER_POOL_H_

#include <memory>

#include "server/batching/window_scheduler.h"
#include "server/common/clock.h"

namespace duet::server::batching {

struct WorkerPoolOptions {
  int workers = 1;
  int max_queued_windows = 1;
};

// A scheduler with a fixed number of threads, each evaluating one window at a time; they are the
// only threads that run a model. Destroying it finishes the windows that have started; those still
// waiting get UNAVAILABLE.
//
// `clock` and `observer`, which may be null, outlive it.
std::unique_ptr<WindowScheduler> MakeWorkerPool(const WorkerPoolOptions& options,
                                                const common::Clock& clock,
                                                WindowObserver* observer = nullptr);

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_WORKER_POOL_H_
