#ifndef DUET_SERVER_BATCHING_BATCH_DECISION_H_
#define DUET_SERVER_BATCHING_BATCH_DECISION_H_

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/status/status.h"
#include "server/batching/window_scheduler.h"
#include "server/common/clock.h"

namespace duet::server::batching {

// The time that a batch takes: a fixed part for each batch, and a part for each frame of each
// window. Both are 0 if nothing is known.
struct CostEstimate {
  double batch_seconds = 0;
  double frame_seconds = 0;

  double Seconds(int frames) const { return batch_seconds + frame_seconds * frames; }
};

// Estimates a model's cost from the batches that it has evaluated, by least squares in which each
// batch weighs a fifth less than the one after it. While all batches have the same size, the cost
// is assumed to be proportional to the frames.
//
// Threads: not safe to call concurrently.
class BatchCost {
 public:
  // `frames`: total of all windows of the batch, at least 1. A time of more than four times the
  // expected one counts as four times, because a pause of the machine does not make a model slow.
  void Observe(int frames, double seconds, common::TimePoint at);

  // The estimate, halved for each second without a batch. Otherwise an estimate that is so high
  // that no window is evaluated would never be corrected.
  CostEstimate At(common::TimePoint now) const;

 private:
  CostEstimate Fit() const;

  // Weighted sums over the batches: of 1, x, y, x^2, x y, with x in frames and y in seconds.
  double weight_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
  common::TimePoint last_;
};

// The queues in which windows wait, the most urgent first. A batch contains windows of one lane
// only, so that long calls do not delay short ones.
enum class Lane {
  kShort,  // interactive calls of little work, and the first window of long ones
  kLong,   // the other windows of long interactive calls
  kBulk
};
inline constexpr std::size_t kLanes = 3;

// A call of more windows is long: more than about 20 s at 15 frames a second.
inline constexpr int kShortCallWindows = 8;

// `call_windows`: number of windows of the whole call, each counted once for each candidate: a call
// with many candidates delays others as much as one that is as many times longer. The caller waits
// for the first frames of a long call as for those of a short one. Later frames only have to keep
// up with playback.
constexpr Lane LaneOf(Priority priority, int call_windows, bool continues_call) {
  if (priority == Priority::kBulk) return Lane::kBulk;
  return continues_call && call_windows > kShortCallWindows ? Lane::kLong : Lane::kShort;
}

// The input of a decision about one waiting window.
struct WaitingWindow {
  std::size_t model = 0;  // index into QueueState::models
  Lane lane = Lane::kShort;
  std::size_t client = 0;         // index of the client among those with waiting windows
  std::int64_t client_turns = 0;  // TurnsOf the windows of the client that have started in the lane
  int frames = 0;  // that the model computes: those of the window, once for each candidate
  common::TimePoint queued_at;
  common::TimePoint deadline = common::TimePoint::max();
  bool cancelled = false;
  common::TimePoint due = common::TimePoint::max();  // see WindowJob
};

// The input of a decision about one model.
struct ModelLoad {
  CostEstimate cost;
  double served_seconds = 0;  // computing time that its windows have used
  int window_frames = 1;      // of its longest window with one candidate
};

// What a window costs as a number of windows of one candidate and of `window_frames`, rounded up.
constexpr int TurnsOf(int frames, int window_frames) {
  return (frames + window_frames - 1) / window_frames;
}

// Number of frames of higher lanes that may overtake each frame of a lane. A lane thus gets at
// least an eighth of the work.
inline constexpr int kOvertaking = 7;

// A window of more turns than this is heavy: others would wait long for the worker that evaluates
// it.
inline constexpr int kLightTurns = 3;

// Everything that a decision depends on.
struct QueueState {
  std::vector<WaitingWindow> windows;  // in the order they came
  std::vector<ModelLoad> models;
  // For each lane, the frames of higher lanes that overtook it since it was last empty, minus
  // kOvertaking times its own frames.
  std::array<int, kLanes> overtaken_frames = {};
  int free_workers = 1;  // including the one that asks
  // When the batches of the other workers are expected to end.
  std::vector<common::TimePoint> busy_until;
  int heavy_batches = 0;  // of the other workers: those with a heavy window
  // When a batch with windows of more than one call last ended.
  common::TimePoint last_company = common::TimePoint::min();
  // When the last window of a short call arrived, and the last one that is not heavy.
  common::TimePoint last_short = common::TimePoint::min();
  common::TimePoint last_light = common::TimePoint::min();
};

struct BatchLimits {
  // Of a batch, 1 or more: neither more windows, nor more frames than so many of the model's
  // longest windows with one candidate. A window with more frames than that runs alone.
  int max_windows = 1;
  // Maximum time that a batch that is not full waits for windows of other calls, if any are likely.
  std::chrono::nanoseconds max_delay{0};
};

// What a worker does next.
struct Decision {
  struct Drop {
    std::size_t window = 0;  // index into QueueState::windows
    absl::Status reason;     // CANCELLED or DEADLINE_EXCEEDED
  };
  std::vector<Drop> dropped;       // fail now, without evaluation
  std::vector<std::size_t> batch;  // evaluate now: of one model and one lane; may be empty
  // When to decide again, even if nothing changes until then.
  common::TimePoint look_again = common::TimePoint::max();
};

// Decides what a free worker does next. A pure function of its arguments.
//
// 1. Drop windows that are cancelled, that are expired, or that could not finish in time even in a
//    batch of their own. In time means an eighth of the window's computing time before its
//    deadline, because the reply still has to travel. Without this margin, an overloaded server
//    would evaluate every window slightly too late.
// 2. Choose the highest lane with windows, unless a lower lane has been overtaken by kOvertaking
//    times as many frames as its next batch holds. No lane starves.
//    While light windows of short calls arrive, heavy windows leave one worker to the others, if
//    there are several workers. A batch has either heavy or light windows.
// 3. Within the lane, choose the model whose windows have used the least computing time.
// 4. Choose windows of the clients in turns: first those after which their client has had the
//    fewest. A window with 16 candidates takes 16 turns, so clients share the work and not the
//    number of windows. Within a client and among equal turns, the order is by urgency: the
//    earliest of the deadline, the time at which it is due, and one second after arrival. Take at
//    most max_windows, and no more than let all workers finish at about the same time. While short
//    calls arrive, a batch of a lower lane takes no longer than three windows of one candidate
//    would take alone, because the next short call waits for it.
// 5. Reduce the batch so that its most urgent window finishes in time, unless that costs more than
//    a quarter of the throughput. In that case, take as many windows as finish in time.
// 6. A batch that is not full waits for up to max_delay, if no other batch waits and windows of
//    other calls are likely: another worker is busy, or windows of several calls were present
//    within max_delay. A single call on an idle server does not wait.
//
// Costs are counted in frames that the model computes: those of a window, once for each candidate.
// The engine computes no padding, so windows are not sorted by length.
Decision Decide(const QueueState& state, const BatchLimits& limits, common::TimePoint now);

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_BATCH_DECISION_H_
