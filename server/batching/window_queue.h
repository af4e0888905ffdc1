#ifndef DUET_SERVER_BATCHING_WINDOW_QUEUE_H_
#define DUET_SERVER_BATCHING_WINDOW_QUEUE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "server/batching/batch_decision.h"
#include "server/batching/window_scheduler.h"
#include "server/common/clock.h"

namespace duet::server::batching {

struct BatcherOptions {
  int workers = 1;
  // Maximum number of first windows of calls that wait, each counted once for each candidate. A
  // single call may wait whatever it costs.
  int max_queued_windows = 1;
  BatchLimits limits;
  // Fraction of max_queued_windows that a single client can fill, in (0, 1]. A client may queue
  // another call while its waiting calls take less than client_share / (1 - client_share) times the
  // free room.
  double client_share = 1;
};

// A job, its time of arrival, and what it costs.
struct QueuedWindow {
  WindowJob job;
  common::TimePoint queued_at;
  int frames = 0;  // that its model is expected to compute: the window's, once for each evaluation
  // Evaluations of the window (engine::EvaluationCount): its candidates, twice as many with a
  // scaled reaction. 1 for a model that does not sample.
  int candidates = 0;

  int Turns() const;  // TurnsOf its frames
};

// A window that will never start, and the reason.
struct DroppedWindow {
  QueuedWindow window;
  absl::Status reason;
};

// Windows of one model to be evaluated together.
struct Batch {
  std::vector<QueuedWindow> windows;
  common::TimePoint started_at;
  double expected_seconds = 0;
  int number = 0;  // unique within a queue

  // Of all windows.
  int Frames() const;
  int Candidates() const;
};

// The work that a worker gets from the queue.
struct Turn {
  std::vector<DroppedWindow> dropped;
  Batch batch;  // may be empty
  // See Decision.
  common::TimePoint look_again = common::TimePoint::max();
};

// The waiting windows, and the history that Decide needs: running batches, the computing time that
// each model has used, the cost of its batches, and the turns that clients have had.
//
//   Turn turn = queue.Next(now);    // for a free worker
//   ... evaluates turn.batch ...
//   queue.Finished(turn.batch, now);
//
// Threads: not safe to call concurrently.
class WindowQueue {
 public:
  explicit WindowQueue(const BatcherOptions& options) : options_(options) {}

  // Returns true if the first window of a call may join: with it, the waiting first windows of all
  // priorities fit into this priority's share of the capacity, and those of its client are below
  // the client's share. Cancelled and expired windows do not count. Further windows of a call may
  // always join.
  bool HasRoomFor(Priority priority, const std::string& client, common::TimePoint now,
                  int candidates = 1) const;
  bool HasRoomFor(const WindowJob& job, common::TimePoint now) const;
  // Returns true if a first window would finish by its deadline after every window that waits in
  // its lane and above, at recent costs. Returns true if no window waits before it: Decide checks
  // whether the window itself finishes in time.
  bool ComesInTime(const WindowJob& job, common::TimePoint now) const;
  void Push(WindowJob job, common::TimePoint now);

  // Returns what a free worker does next.
  Turn Next(common::TimePoint now);
  // A batch was evaluated.
  void Finished(const Batch& batch, common::TimePoint now);
  // Empties the queue. Windows that are neither cancelled nor expired fail with `reason`.
  std::vector<DroppedWindow> DropAll(const absl::Status& reason, common::TimePoint now);

  std::size_t size() const { return waiting_.size(); }
  // Of all waiting windows.
  std::size_t candidates() const;
  std::size_t capacity() const { return static_cast<std::size_t>(options_.max_queued_windows); }

 private:
  // The history of a model.
  struct Account {
    std::weak_ptr<const engine::Synthesizer> model;
    BatchCost cost;
    double served_seconds = 0;
    int waiting = 0;
  };
  // A client with waiting windows in a lane.
  struct ClientTurns {
    std::int64_t turns = 0;  // see WaitingWindow::client_turns
    int waiting = 0;
  };
  // The clients of a lane. A client that comes, or comes back, continues from the turns of the
  // client whose window started last: it neither claims the time in which it was idle nor waits for
  // the others to catch up (self-clocked fair queueing, Golestani 1994).
  struct LaneClients {
    std::map<std::string, ClientTurns> waiting;
    std::int64_t turns_by_now = 0;
  };

  LaneClients& ClientsOf(const WindowJob& job);
  void CountTurns(const QueuedWindow& window);
  Account& AccountOf(const WindowJob& job);
  CostEstimate CostOf(const WindowJob& job, common::TimePoint now) const;
  QueueState StateAt(common::TimePoint now) const;
  // Removes the window at an index and leaves one with a null model, for RemoveTaken.
  QueuedWindow TakeOut(std::size_t index);
  void RemoveTaken();
  void CountOvertaking(const Batch& batch);
  void Start(Batch& batch, common::TimePoint now);

  const BatcherOptions options_;
  std::vector<QueuedWindow> waiting_;  // in order of arrival
  std::map<const engine::Synthesizer*, Account> accounts_;
  struct Running {
    common::TimePoint end;  // expected
    bool is_heavy = false;
  };
  std::map<int, Running> running_;  // by batch number
  std::array<int, kLanes> overtaken_frames_ = {};
  std::array<LaneClients, kLanes> clients_;
  common::TimePoint last_company_ = common::TimePoint::min();
  common::TimePoint last_short_ = common::TimePoint::min();
  common::TimePoint last_light_ = common::TimePoint::min();
  // The computing time that the model whose batch started last had used by then. A model without
  // waiting windows continues from here, because an idle model must not claim all the time that it
  // did not use.
  double served_by_now_ = 0;
  int batches_ = 0;
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

#endif  // DUET_SERVER_BATCHING_WINDOW_QUEUE_H_
