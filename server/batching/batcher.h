#ifndef DUET_SERVER_BATCHING_BATCHER_H_
#define DUET_SERVER_BATCHING_BATCHER_H_

#include <memory>

#include "server/batching/batch_decision.h"
#include "server/batching/window_scheduler.h"
#include "server/common/clock.h"

namespace duet::server::batching {

struct BatcherOptions {
  int workers = 1;
  int max_queued_windows = 1;  // calls waiting for their first window
  BatchLimits limits;
  double client_share = 1;  // see WindowQueueOptions
};

// A scheduler with a fixed number of threads, each evaluating a batch of one model's windows at a
// time; they are the only threads that run a model. What a thread takes next is decided by Decide
// (batch_decision.h). Destroying it finishes the batches that have started; windows still waiting
// get UNAVAILABLE.
//
// `clock` and `observer`, which may be null, outlive it.
std::unique_ptr<WindowScheduler> MakeBatcher(const BatcherOptions& options,
                                             const common::Clock& clock,
                                             WindowObserver* observer = nullptr);

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_BATCHER_H_
