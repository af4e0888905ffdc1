#include "server/batching/batch_decision.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace duet::server::batching {

namespace {

constexpr double kKept = 0.8;           // weight of earlier batches, for each new one
constexpr double kMostSurprise = 4;     // maximum ratio to the expected seconds
constexpr double kHalfLifeSeconds = 1;  // of an estimate without new batches
// Sizes that vary by less than this fraction of their mean do not determine the cost of a frame.
constexpr double kTellingSpread = 0.1;

}  // namespace

void BatchCost::Observe(int frames, double seconds, common::TimePoint at) {
  const double x = frames;
  const double y = weight_ > 0 ? std::min(seconds, kMostSurprise * Fit().Seconds(frames)) : seconds;
  weight_ = kKept * weight_ + 1;
  x_ = kKept * x_ + x;
  y_ = kKept * y_ + y;
  xx_ = kKept * xx_ + x * x;
  xy_ = kKept * xy_ + x * y;
  last_ = at;
}

CostEstimate BatchCost::At(common::TimePoint now) const {
  if (weight_ == 0) return {};
  const double idle_seconds = std::max(0.0, common::SecondsBetween(last_, now));
  const double trust = std::exp2(-idle_seconds / kHalfLifeSeconds);
  const CostEstimate fit = Fit();
  return {trust * fit.batch_seconds, trust * fit.frame_seconds};
}

CostEstimate BatchCost::Fit() const {
  const double mean_x = x_ / weight_, mean_y = y_ / weight_;
  const double variance = xx_ / weight_ - mean_x * mean_x;
  const double covariance = xy_ / weight_ - mean_x * mean_y;
  const double proportional = mean_y / mean_x;
  // Least squares, regularised towards proportionality if the sizes vary too little.
  const double prior = std::pow(kTellingSpread * mean_x, 2);
  const double slope = (covariance + prior * proportional) / (variance + prior);
  // Both parts are at least 0.
  const double frame_seconds = std::clamp(slope, 0.0, proportional);
  return {mean_y - frame_seconds * mean_x, frame_seconds};
}

namespace {

// Returns the seconds until all frames are done if the free workers, and the workers that become
// free early enough, share them. `busy_seconds` is ascending.
double EndOfAll(int frames, int free_workers, const std::vector<double>& busy_seconds,
                const CostEstimate& cost) {
  int workers = free_workers;
  double work = frames * cost.frame_seconds + workers * cost.batch_seconds;
  for (const double busy : busy_seconds) {
    if (busy + cost.batch_seconds >= work / workers) break;
    work += busy + cost.batch_seconds;
    ++workers;
  }
  return work / workers;
}

// Returns how many of `frames` waiting frames (at least 1) a free worker takes so that all workers
// finish at about the same time: between 1 and `frames`. While the cost is unknown, the free
// workers take equal numbers.
//
// `busy_seconds`: remaining time of each batch that other workers evaluate. `free_workers`:
// including the one that asks, at least 1.
int EvenShare(int frames, int free_workers, std::vector<double> busy_seconds,
              const CostEstimate& cost) {
  double share = static_cast<double>(frames) / free_workers;
  if (cost.frame_seconds > 0) {
    std::sort(busy_seconds.begin(), busy_seconds.end());
    const double end = EndOfAll(frames, free_workers, busy_seconds, cost);
    share = (end - cost.batch_seconds) / cost.frame_seconds;
  }
  // Slightly less, so that rounding errors do not add a frame.
  return std::clamp(static_cast<int>(std::ceil(share - 1e-6)), 1, frames);
}

using Indices = std::vector<std::size_t>;
using common::SecondsBetween;
using common::TimePoint;

// The urgency of a window without an earlier deadline: late enough that nearer deadlines go first,
// early enough that it does not wait long.
constexpr std::chrono::seconds kPatience(1);
// Maximum fraction of the throughput that an urgent window may cost.
constexpr double kThroughputKept = 0.75;
// Fraction of the time from arrival to deadline that is reserved for sending the reply.
constexpr int kWayBack = 8;
// While short calls arrive, a batch of a lower lane may take as long as this many single windows of
// one candidate.
// Short calls are considered to arrive until none has arrived for this time.
constexpr double kHeldUp = kLightTurns;
constexpr std::chrono::seconds kShortCallsCome(1);

// The steps of the decision for one state.
class Decider {
 public:
  Decider(const QueueState& state, const BatchLimits& limits, TimePoint now)
      : state_(state), limits_(limits), now_(now) {}

  Decision Decide() {
    Decision decision;
    for (std::size_t i = 0; i < state_.windows.size(); ++i) {
      absl::Status reason = ReasonToDrop(i);
      if (reason.ok()) {
        alive_.push_back(i);
      } else {
        decision.dropped.push_back({i, std::move(reason)});
      }
    }
    const bool takes_heavy = LeavesAWorkerToOthers();
    for (const std::size_t i : alive_) {
      if (takes_heavy || !IsHeavy(i)) ready_.push_back(i);
    }
    if (ready_.size() < alive_.size()) decision.look_again = state_.last_light + kShortCallsCome;
    Indices batch = NextBatch();
    if (batch.empty()) return decision;
    if (const std::optional<TimePoint> start_at = WaitFor(batch)) {
      decision.look_again = std::min(decision.look_again, *start_at);
    } else {
      decision.batch = std::move(batch);
    }
    return decision;
  }

 private:
  const WaitingWindow& Window(std::size_t index) const { return state_.windows[index]; }
  const ModelLoad& ModelOf(std::size_t index) const { return state_.models[Window(index).model]; }
  const CostEstimate& CostOf(std::size_t index) const { return ModelOf(index).cost; }
  // The most frames of a batch of the window's model.
  int MostFrames(std::size_t index) const {
    return limits_.max_windows * ModelOf(index).window_frames;
  }
  // When the window's evaluation must have finished.
  TimePoint DueAt(std::size_t index) const {
    const TimePoint deadline = Window(index).deadline;
    return deadline - (deadline - Window(index).queued_at) / kWayBack;
  }
  double SecondsLeft(std::size_t index) const { return SecondsBetween(now_, DueAt(index)); }

  int FramesOf(const Indices& windows) const {
    return std::accumulate(windows.begin(), windows.end(), 0, [&](int sum, std::size_t window) {
      return sum + Window(window).frames;
    });
  }

  // of one model, not empty
  double SecondsOf(const Indices& batch) const {
    return CostOf(batch.front()).Seconds(FramesOf(batch));
  }

  absl::Status ReasonToDrop(std::size_t index) const {
    const WaitingWindow& window = Window(index);
    if (window.cancelled) {
      return absl::CancelledError("the call was cancelled before this window started");
    }
    if (now_ >= window.deadline) {
      return absl::DeadlineExceededError("the deadline passed before this window started");
    }
    const double needed = CostOf(index).Seconds(window.frames);
    if (SecondsLeft(index) < needed) {
      return absl::DeadlineExceededError(
          "this window would have come too late: it takes about " + std::to_string(needed) +
          " s, the deadline is " + std::to_string(SecondsBetween(now_, window.deadline)) +
          " s away, and the answer needs time as well; it was not started");
    }
    return absl::OkStatus();
  }

  bool IsHeavy(std::size_t index) const {
    return TurnsOf(Window(index).frames, ModelOf(index).window_frames) > kLightTurns;
  }

  // Returns whether a worker remains for light windows if this one takes a heavy window, as far as
  // that is necessary.
  bool LeavesAWorkerToOthers() const {
    const int workers = state_.free_workers + static_cast<int>(state_.busy_until.size());
    return workers == 1 || state_.heavy_batches + 1 < workers ||
           now_ >= state_.last_light + kShortCallsCome;
  }

  Indices LaneBatch(Lane lane) const {
    std::optional<std::size_t> model;  // the least served; among equals, the first to arrive
    for (const std::size_t i : ready_) {
      if (Window(i).lane != lane) continue;
      const std::size_t other = Window(i).model;
      if (!model || state_.models[other].served_seconds < state_.models[*model].served_seconds) {
        model = other;
      }
    }
    if (!model) return {};
    Indices line = WantedFirst(lane, *model);
    // A batch ends for all of its windows at the same time.
    const auto other_kind = [this, is_heavy = IsHeavy(line.front())](std::size_t i) {
      return IsHeavy(i) != is_heavy;
    };
    line.erase(std::remove_if(line.begin(), line.end(), other_kind), line.end());
    std::size_t most = MostOf(line);
    if (lane != Lane::kShort) most = std::min(most, NotHeldUp(line));
    return InTime(line, most);
  }

  Indices WantedFirst(Lane lane, std::size_t model) const {
    Indices line;
    for (const std::size_t i : ready_) {
      if (Window(i).lane == lane && Window(i).model == model) line.push_back(i);
    }
    const auto wanted_at = [&](std::size_t i) {
      return std::min({Window(i).deadline, Window(i).due, Window(i).queued_at + kPatience});
    };
    std::stable_sort(line.begin(), line.end(),
                     [&](std::size_t a, std::size_t b) { return wanted_at(a) < wanted_at(b); });
    return InTurns(line);
  }

  // Returns the same windows, of one model, with clients taking turns.
  Indices InTurns(const Indices& line) const {
    std::map<std::size_t, std::int64_t> had;  // client -> its turns so far
    std::vector<std::pair<std::int64_t, std::size_t>> turns;
    turns.reserve(line.size());
    for (const std::size_t i : line) {
      std::int64_t& of_client = had.emplace(Window(i).client, Window(i).client_turns).first->second;
      of_client += TurnsOf(Window(i).frames, ModelOf(i).window_frames);
      turns.emplace_back(of_client, i);
    }
    std::stable_sort(turns.begin(), turns.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    Indices taking_turns;
    taking_turns.reserve(line.size());
    for (const auto& [turn, i] : turns) taking_turns.push_back(i);
    return taking_turns;
  }

  // Returns the number of the first windows, at least 1, that a batch holds at most.
  std::size_t MostOf(const Indices& line) const {
    std::vector<double> busy_seconds;
    for (const TimePoint end : state_.busy_until) {
      busy_seconds.push_back(std::max(0.0, SecondsBetween(now_, end)));
    }
    const int share = EvenShare(FramesOf(alive_), state_.free_workers, std::move(busy_seconds),
                                CostOf(line.front()));
    const std::size_t most = std::min(line.size(), static_cast<std::size_t>(limits_.max_windows));
    std::size_t count = 1;
    int frames = Window(line.front()).frames;
    for (; count < most; ++count) {
      const int more = Window(line[count]).frames;
      // A window of which the larger part exceeds the share is for another worker.
      if (frames + more > MostFrames(line.front()) || frames + more / 2 > share) break;
      frames += more;
    }
    return count;
  }

  // Returns the maximum number of windows that do not delay a short call too long.
  std::size_t NotHeldUp(const Indices& line) const {
    if (now_ >= state_.last_short + kShortCallsCome) return line.size();
    const CostEstimate& cost = CostOf(line.front());
    // Slightly more, so that rounding errors do not remove a window.
    const double longest =
        (kHeldUp + 1e-6) *
        cost.Seconds(std::min(Window(line.front()).frames, ModelOf(line.front()).window_frames));
    std::size_t count = 1;
    int frames = Window(line.front()).frames;
    for (; count < line.size(); ++count) {
      frames += Window(line[count]).frames;
      if (cost.Seconds(frames) > longest) break;
    }
    return count;
  }

  // Returns windows, at least 1 and at most the given number, whose batch finishes in time for
  // each.
  Indices InTime(const Indices& line, std::size_t most) const {
    Indices full(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(most));
    Indices urgent = ForTheMostUrgent(full);
    // Otherwise the largest batch that finishes in time for enough of its windows.
    for (; full.size() > urgent.size(); full.resize(full.size() / 2)) {
      Indices others = WithTimeFor(full, line);
      if (others.empty()) continue;
      if (Throughput(urgent) < kThroughputKept * Throughput(others)) return others;
    }
    return urgent;
  }

  // Returns the longest prefix of a batch that finishes in time for each of its windows.
  Indices ForTheMostUrgent(const Indices& full) const {
    Indices batch;
    double least_left = SecondsLeft(full.front());
    for (const std::size_t window : full) {
      least_left = std::min(least_left, SecondsLeft(window));
      batch.push_back(window);
      if (batch.size() > 1 && SecondsOf(batch) > least_left) {
        batch.pop_back();
        break;
      }
    }
    return batch;
  }

  // Returns the first windows that have time left for a full batch, and of which it holds as many.
  Indices WithTimeFor(const Indices& full, const Indices& line) const {
    const double seconds = SecondsOf(full);
    int room = FramesOf(full);
    Indices batch;
    for (const std::size_t window : line) {
      if (batch.size() == full.size()) break;
      if (SecondsLeft(window) < seconds || Window(window).frames > room) continue;
      room -= Window(window).frames;
      batch.push_back(window);
    }
    return batch;
  }

  // Frames per second. Compared only if the cost is known; otherwise no batch is too long.
  double Throughput(const Indices& batch) const { return FramesOf(batch) / SecondsOf(batch); }

  // Returns the batch of the lane whose turn it is; empty if no window waits.
  Indices NextBatch() const {
    Indices highest;
    for (std::size_t lane = kLanes; lane-- > 0;) {
      Indices batch = LaneBatch(static_cast<Lane>(lane));
      if (batch.empty()) continue;
      if (state_.overtaken_frames[lane] >= kOvertaking * FramesOf(batch)) return batch;
      highest = std::move(batch);
    }
    return highest;
  }

  // Returns until when a batch waits for windows of other calls; absent if it starts now.
  std::optional<TimePoint> WaitFor(const Indices& batch) const {
    // No further window of one candidate may join.
    const bool full =
        batch.size() == static_cast<std::size_t>(limits_.max_windows) ||
        FramesOf(batch) + ModelOf(batch.front()).window_frames > MostFrames(batch.front());
    if (full || batch.size() < alive_.size()) return std::nullopt;
    TimePoint end = TimePoint::max();
    if (state_.busy_until.empty()) end = state_.last_company + limits_.max_delay;
    const std::chrono::duration<double> needed(SecondsOf(batch));
    for (const std::size_t i : batch) {
      end = std::min(end, Window(i).queued_at + limits_.max_delay);
      end = std::min(end, DueAt(i) - std::chrono::duration_cast<TimePoint::duration>(needed));
    }
    if (end <= now_) return std::nullopt;
    return end;
  }

  const QueueState& state_;
  const BatchLimits& limits_;
  const TimePoint now_;
  Indices alive_;  // windows that are not dropped
  Indices ready_;  // those of them that this worker may take
};

}  // namespace

Decision Decide(const QueueState& state, const BatchLimits& limits, TimePoint now) {
  return Decider(state, limits, now).Decide();
}

}  // namespace duet::server::batching
