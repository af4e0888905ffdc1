#ifndef DUET_SERVER_BATCHING_BATCHER_H_
#define DUET_SERVER_BATCHING_BATCHER_H_

#include <memory>

#include "server/batching/batch_decision.h"
#include "server/batching/window_scheduler.h"
#include "server/common/clock.h"

namespace duet::server::batching {

struct BatcherOptions {
  int workers = 1;
  int max_queued_windows = 1;  // see WindowQueueOptions::capacity
  BatchLimits limits;
  double client_share = 1;  // see WindowQueueOptions
};

// Creates a scheduler with a fixed number of threads. Each thread evaluates one batch of windows of
// one model at a time. No other thread runs a model. Decide (batch_decision.h) chooses the next
// batch. The destructor waits for batches that have started; windows still waiting fail with
// UNAVAILABLE.
//
// `clock` and `observer` outlive the scheduler. `observer` may be null.
std::unique_ptr<WindowScheduler> MakeBatcher(const BatcherOptions& options,
                                             const common::Clock& clock,
                                             WindowObserver* observer = nullptr);

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_BATCHER_H_
