#ifndef DUET_SERVER_BATCHING_WINDOW_SCHEDULER_H_
#define DUET_SERVER_BATCHING_WINDOW_SCHEDULER_H_

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "model/engine/synthesizer.h"
#include "server/batching/priority.h"
#include "server/common/clock.h"

namespace duet::server::batching {

// Where a window's time went.
struct WindowTimings {
  double queue_seconds = 0;
  double compute_seconds = 0;  // of the batch that the window was part of
  int batch_size = 0;          // windows evaluated together; 0 when the window never started
};

struct WindowOutcome {
  engine::WindowResult result;
  WindowTimings timings;
};

// One network evaluation, and whom to tell.
struct WindowJob {
  std::shared_ptr<const engine::Synthesizer> model;
  engine::SynthesisWindow window;
  Priority priority = Priority::kInteractive;
  common::TimePoint deadline = common::TimePoint::max();
  // The owner sets it to give the result up, the model stops soon if it has begun. Required.
  std::shared_ptr<const std::atomic<bool>> cancelled;
  // A further window of a call that is being answered. Never refused for a full queue: what was
  // begun is finished, and a call has one window in the queue at most.
  bool continues_call = false;
  // Whose call it is: clients take turns. Empty is a client as well.
  std::string client;
  // How many windows the whole call has, 1 or more. A long call gives way to shorter ones.
  int call_windows = 1;
  // Called once, on a thread of the scheduler, under no lock. Must not throw.
  std::function<void(WindowOutcome)> done;
};

// Told of every batch, and of every window that left a scheduler's queue, whether it was evaluated
// or dropped.
//
// Threads: called concurrently, on the scheduler's threads, under no lock. Must neither block nor
// throw.
class WindowObserver {
 public:
  virtual ~WindowObserver() = default;
  // A batch was evaluated: compute_seconds and batch_size are set.
  virtual void BatchFinished(const WindowTimings& timings) = 0;
  virtual void WindowFinished(Priority priority, const WindowTimings& timings) = 0;
};

// Decides when windows are evaluated, and with which others. Callers do not notice the others.
//
//   absl::Status admitted = scheduler.Submit(std::move(job));
//   if (!admitted.ok()) return admitted;   // job.done will never run
//
// A job that is cancelled, past its deadline or too close to it to be done in time never starts:
// done gets CANCELLED or DEADLINE_EXCEEDED.
//
// Threads: safe to call concurrently.
class WindowScheduler {
 public:
  virtual ~WindowScheduler() = default;

  // Takes the job: done will run exactly once, never within Submit.
  // Fails with RESOURCE_EXHAUSTED when the queue is full or too long for the deadline of a call's
  // first window, with UNAVAILABLE when shutting down;
  // done then never runs.
  virtual absl::Status Submit(WindowJob job) = 0;

  // Whether the first window of a call of this priority and client would find room in the queue
  // now: OK, or what Submit would say. Asked before a call is worked on at all.
  virtual absl::Status CheckRoom(Priority priority, const std::string& client) const = 0;

  // Windows that wait for their turn now.
  virtual std::size_t queued_windows() const = 0;
};

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_WINDOW_SCHEDULER_H_
