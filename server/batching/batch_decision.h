#ifndef DUET_SERVER_BATCHING_BATCH_DECISION_H_
#define DUET_SERVER_BATCHING_BATCH_DECISION_H_

#include <array>
#include <chrono>
#include <cstddef>
#include <vector>

#include "absl/status/status.h"
#include "server/batching/batch_cost.h"
#include "server/batching/lane.h"
#include "server/common/clock.h"

namespace duet::server::batching {

// What the decision knows of a window that waits.
struct WaitingWindow {
  std::size_t model = 0;  // index into QueueState::models
  Lane lane = Lane::kShort;
  std::size_t client = 0;  // a number for each client that waits
  int frames = 0;
  common::TimePoint queued_at;
  common::TimePoint deadline = common::TimePoint::max();
  bool cancelled = false;
};

// What it knows of a model.
struct ModelLoad {
  CostEstimate cost;
  double served_seconds = 0;  // computing time that its windows have had
};

// So many frames of higher lanes may overtake each frame of a lane: an eighth of the whole is its.
inline constexpr int kOvertaking = 7;

// Of the time from a window's coming to its deadline, the part kept for its answer's way to the
// caller: an eighth.
inline constexpr int kWayBack = 8;

// Everything that decides what a worker does next.
struct QueueState {
  std::vector<WaitingWindow> windows;  // in the order they came
  std::vector<ModelLoad> models;
  // For each lane, the frames of higher lanes' batches that overtook it since it last was empty,
  // less kOvertaking times those of its own.
  std::array<int, kLanes> overtaken_frames = {};
  int free_workers = 1;  // with the one that asks
  // When the batches of the other workers are expected to end.
  std::vector<common::TimePoint> busy_until;
  // When windows of more than one call were last seen together: a batch of them ended.
  common::TimePoint last_company = common::TimePoint::min();
  // When the last window of a short call came.
  common::TimePoint last_short = common::TimePoint::min();
};

struct BatchLimits {
  int max_windows = 1;  // of a batch, 1 or more
  // How long a batch that is not full waits for company while there is any about.
  std::chrono::nanoseconds max_delay{0};
};

// What a worker is to do.
struct Decision {
  struct Drop {
    std::size_t window = 0;  // index into QueueState::windows
    absl::Status reason;     // CANCELLED or DEADLINE_EXCEEDED
  };
  std::vector<Drop> dropped;       // to be answered now, without being evaluated
  std::vector<std::size_t> batch;  // to be evaluated now: of one model and one lane; may be empty
  // When to decide again even if nothing happens until then.
  common::TimePoint look_again = common::TimePoint::max();
};

// Decides what a free worker does. A function of its arguments alone.
//
// 1. Windows that are cancelled, expired, or so close to their deadline that the model would not be
//    done in time even with each alone, are dropped. In time is an eighth of a window's time before
//    its deadline: the answer has a way to go, and under overload every window would else be
//    evaluated just too late.
// 2. The highest lane with windows has its turn, unless a lower one has been overtaken by
// kOvertaking
//    times as many frames as its next batch holds: no lane starves.
// 3. Within the lane, the model whose windows have had the least computing time.
// 4. Clients take turns: one window of each, the second of each, and so on. Of the windows of one
//    client, and of each such round, those that are wanted first: at their deadline, or a second
//    after they came. At most max_windows, and no more than let all workers end at about the same
//    time. While short calls come, a batch of a lower lane is no longer than three of its windows
//    alone: that is what the next short call waits for.
// 5. A batch is kept small enough for its most urgent window, unless that costs more than a quarter
//    of throughput: then those for which the batch comes in time go, as many as there are.
// 6. A batch that is not full waits, up to max_delay, if nothing else does and company is likely:
//    another worker is busy or windows of several calls were there within max_delay. A lone call on
//    an idle server waits for nobody.
//
// Costs count in frames: the engine computes no padding, so windows are not sorted by length.
Decision Decide(const QueueState& state, const BatchLimits& limits, common::TimePoint now);

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_BATCH_DECISION_H_
