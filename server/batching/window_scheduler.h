#ifndef DUET_SERVER_BATCHING_WINDOW_SCHEDULER_H_
#define DUET_SERVER_BATCHING_WINDOW_SCHEDULER_H_

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "model/engine/synthesizer.h"
#include "server/common/clock.h"

namespace duet::server::batching {

// How urgent a call is. Bulk windows start after waiting interactive windows; see Decide.
enum class Priority { kInteractive, kBulk };

// Returns the name in metrics and logs.
constexpr std::string_view PriorityName(Priority priority) {
  return priority == Priority::kBulk ? "bulk" : "interactive";
}

// Returns the part of a limit that calls of a priority may use: all of it for interactive calls,
// three quarters for bulk calls, so that a quarter remains free for interactive calls.
constexpr std::size_t ShareOf(std::size_t limit, Priority priority) {
  return priority == Priority::kBulk ? limit - limit / 4 : limit;
}

// How long a window waited and how long it was computed.
struct WindowTimings {
  double queue_seconds = 0;
  double compute_seconds = 0;  // of the batch that the window was part of
  // Windows evaluated together, each counted once for each candidate; 0 when the window never
  // started.
  int batch_size = 0;
  int frames = 0;  // of the window, once for each sample that was to be expected; 0 likewise
};

struct WindowOutcome {
  engine::WindowResult result;
  WindowTimings timings;
};

// One network evaluation and the callback for its result.
struct WindowJob {
  std::shared_ptr<const engine::Synthesizer> model;
  engine::SynthesisWindow window;
  Priority priority = Priority::kInteractive;
  common::TimePoint deadline = common::TimePoint::max();
  // When the result is wanted, if that is earlier than one second from now. Unlike the deadline, a
  // window that misses it is still evaluated.
  common::TimePoint due = common::TimePoint::max();
  // Required. Set by the owner when the result is not needed any more. A model that has started
  // stops soon.
  std::shared_ptr<const std::atomic<bool>> cancelled;
  // True for every window of a call but the first, and for every window of a live session. Such a
  // window is never rejected because the queue is full, so that calls that have started can finish.
  // A call has at most one window in the queue.
  bool continues_call = false;
  // The client of the call. Clients take turns. The empty string is a client too.
  std::string client;
  // Number of windows of the whole call, at least 1. Calls of much work yield to others (LaneOf).
  int call_windows = 1;
  // Called once, on a thread of the scheduler, under no lock. Must not throw.
  std::function<void(WindowOutcome)> done;
};

// Notified of every batch, and of every window that leaves a scheduler's queue, whether it was
// evaluated or dropped.
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

// Decides when windows are evaluated, and which of them together. Batching does not change results.
//
//   absl::Status admitted = scheduler.Submit(std::move(job));
//   if (!admitted.ok()) return admitted;   // job.done is never called
//
// A job that is cancelled, past its deadline, or too close to it to finish in time never starts.
// Its done gets CANCELLED or DEADLINE_EXCEEDED.
//
// Threads: safe to call concurrently.
class WindowScheduler {
 public:
  virtual ~WindowScheduler() = default;

  // Queues the job. Calls done exactly once, never within Submit. Returns RESOURCE_EXHAUSTED if the
  // queue is full or too long for the deadline of a call's first window, and UNAVAILABLE during
  // shutdown; done is then never called.
  virtual absl::Status Submit(WindowJob job) = 0;

  // Returns what Submit would return now for the first window of a call of this priority and
  // client, with one candidate and without regard to its deadline. Called before a call is
  // processed.
  virtual absl::Status CheckRoom(Priority priority, const std::string& client) const = 0;

  // Returns the number of waiting windows, each counted once for each candidate.
  virtual std::size_t queued_windows() const = 0;
};

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_WINDOW_SCHEDULER_H_
