#ifndef DUET_SERVER_BATCHING_WINDOW_QUEUE_H_
#define DUET_SERVER_BATCHING_WINDOW_QUEUE_H_

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "server/batching/batch_cost.h"
#include "server/batching/batch_decision.h"
#include "server/batching/lane.h"
#include "server/batching/window_scheduler.h"

namespace duet::server::batching {

// A job and when it came.
struct QueuedWindow {
  WindowJob job;
  common::TimePoint queued_at;
};

// A window that will never start, and why.
struct DroppedWindow {
  QueuedWindow window;
  absl::Status reason;
};

// Windows of one model to be evaluated together.
struct Batch {
  std::vector<QueuedWindow> windows;
  common::TimePoint started_at;
  double expected_seconds = 0;
  int number = 0;  // tells a queue's batches apart

  int Frames() const;
};

// What a worker got from the queue.
struct Turn {
  std::vector<DroppedWindow> dropped;
  Batch batch;  // may be empty
  // See Decision.
  common::TimePoint look_again = common::TimePoint::max();
};

struct WindowQueueOptions {
  std::size_t capacity = 1;  // calls waiting for their first window above which no new one is taken
  int workers = 1;
  BatchLimits limits;
  // A client's first windows may wait as long as they are fewer than this part of the room left by
  // all, over 1 less this part: alone it fills this part of the capacity, 1 all of it.
  double client_share = 1;
};

// The windows that wait, and what Decide needs to know of the past: which batches run, what each
// model has had and what its batches cost.
//
//   Turn turn = queue.Next(now);    // a free worker asks
//   ... evaluates turn.batch ...
//   queue.Finished(turn.batch, now);
//
// Threads: not safe to call concurrently.
class WindowQueue {
 public:
  explicit WindowQueue(const WindowQueueOptions& options) : options_(options) {}

  // True when the first window of a call may join: while fewer first windows wait, of whatever
  // priority, than its own priority's share of the capacity, and fewer of its client's than the
  // client's share. Those that are cancelled or expired take no room. Further windows always may.
  bool HasRoomFor(Priority priority, const std::string& client, common::TimePoint now) const;
  bool HasRoomFor(const WindowJob& job, common::TimePoint now) const {
    return job.continues_call || HasRoomFor(job.priority, job.client, now);
  }
  // Whether a first window would be done by its deadline, an eighth of its time before it, if all
  // that waits in its lane and above went before it: by what windows cost of late. True for one
  // that would wait for nobody: whether it is done in time alone is for Decide to say.
  bool ComesInTime(const WindowJob& job, common::TimePoint now) const;
  void Push(WindowJob job, common::TimePoint now);

  // What the worker that asks is to do.
  Turn Next(common::TimePoint now);
  // The batch was evaluated.
  void Finished(const Batch& batch, common::TimePoint now);
  // Empties the queue: the windows that are neither cancelled nor expired end with `reason`.
  std::vector<DroppedWindow> DropAll(const absl::Status& reason, common::TimePoint now);

  std::size_t size() const { return waiting_.size(); }
  std::size_t capacity() const { return options_.capacity; }

 private:
  // What a model has had.
  struct Account {
    std::weak_ptr<const engine::Synthesizer> model;
    BatchCost cost;
    double served_seconds = 0;
    int waiting = 0;
  };

  Account& AccountOf(const WindowJob& job);
  CostEstimate CostOf(const WindowJob& job, common::TimePoint now) const;
  QueueState StateAt(common::TimePoint now) const;
  // Takes the windows at these indices out, in this order; leaves null models behind.
  QueuedWindow TakeOut(std::size_t index);
  void RemoveTaken();
  void CountOvertaking(const Batch& batch);
  void Start(Batch& batch, common::TimePoint now);

  const WindowQueueOptions options_;
  std::vector<QueuedWindow> waiting_;  // in the order they came
  std::map<const engine::Synthesizer*, Account> accounts_;
  std::map<int, common::TimePoint> running_;  // batch number -> expected end
  std::array<int, kLanes> overtaken_frames_ = {};
  common::TimePoint last_company_ = common::TimePoint::min();
  common::TimePoint last_short_ = common::TimePoint::min();
  // What the model whose batch started last had had by then. A model whose line was empty goes on
  // from here: having had nothing for a while gives no claim to everything now.
  double served_by_now_ = 0;
  int batches_ = 0;
};

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_WINDOW_QUEUE_H_
