#include "server/batching/window_queue.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>
#include <utility>

#include "model/engine/asked_turns.h"

namespace duet::server::batching {
namespace {

using common::TimePoint;

TimePoint After(TimePoint start, double seconds) {
  return start +
         std::chrono::duration_cast<TimePoint::duration>(std::chrono::duration<double>(seconds));
}

int FramesOf(const WindowJob& job) {
  return static_cast<int>(
      std::lround(job.window.leader.frame_count() *
                  engine::ExpectedSamples(job.model->description(), job.window)));
}

Lane LaneOf(const WindowJob& job) {
  return LaneOf(job.priority, job.call_windows, job.continues_call);
}

bool IsCancelled(const WindowJob& job) { return job.cancelled->load(std::memory_order_acquire); }

}  // namespace

int Batch::Frames() const {
  int frames = 0;
  for (const QueuedWindow& window : windows) frames += window.frames;
  return frames;
}

bool WindowQueue::HasRoomFor(Priority priority, const std::string& client, TimePoint now) const {
  const std::size_t most = ShareOf(options_.capacity, priority);
  std::size_t taken = 0, held = 0;
  for (const QueuedWindow& window : waiting_) {
    const WindowJob& job = window.job;
    if (job.continues_call || IsCancelled(job) || now >= job.deadline) continue;
    ++taken;
    held += job.client == client ? 1 : 0;
  }
  if (taken >= most) return false;
  return held == 0 || (1 - options_.client_share) * static_cast<double>(held) <
                          options_.client_share * static_cast<double>(most - taken);
}

bool WindowQueue::ComesInTime(const WindowJob& job, TimePoint now) const {
  double work = 0, batch_seconds = 0;
  int windows = 0;
  for (const auto& [waiting, queued_at, frames] : waiting_) {
    if (LaneOf(waiting) > LaneOf(job) || IsCancelled(waiting) || now >= waiting.deadline) continue;
    const CostEstimate cost = CostOf(waiting, now);
    work += cost.frame_seconds * frames;
    batch_seconds = std::max(batch_seconds, cost.batch_seconds);
    ++windows;
  }
  if (windows == 0) return true;
  const int batches = (windows + options_.limits.max_windows - 1) / options_.limits.max_windows;
  work += batches * batch_seconds;
  for (const auto& [number, end] : running_) {
    work += std::max(0.0, common::SecondsBetween(now, end));
  }
  const double seconds = work / options_.workers + CostOf(job, now).Seconds(FramesOf(job));
  return job.deadline == TimePoint::max() || seconds <= common::SecondsBetween(now, job.deadline);
}

CostEstimate WindowQueue::CostOf(const WindowJob& job, TimePoint now) const {
  const auto found = accounts_.find(job.model.get());
  return found == accounts_.end() ? CostEstimate() : found->second.cost.At(now);
}

void WindowQueue::Push(WindowJob job, TimePoint now) {
  Account& account = AccountOf(job);
  if (account.waiting == 0) {
    account.served_seconds = std::max(account.served_seconds, served_by_now_);
  }
  ++account.waiting;
  if (LaneOf(job) == Lane::kShort) last_short_ = now;
  const int frames = FramesOf(job);
  waiting_.push_back({std::move(job), now, frames});
}

Turn WindowQueue::Next(TimePoint now) {
  Decision decision = Decide(StateAt(now), options_.limits, now);
  Turn turn;
  turn.look_again = decision.look_again;
  for (Decision::Drop& drop : decision.dropped) {
    turn.dropped.push_back({TakeOut(drop.window), std::move(drop.reason)});
  }
  for (const std::size_t index : decision.batch) turn.batch.windows.push_back(TakeOut(index));
  RemoveTaken();
  CountOvertaking(turn.batch);
  if (!turn.batch.windows.empty()) Start(turn.batch, now);
  return turn;
}

void WindowQueue::Finished(const Batch& batch, TimePoint now) {
  const double seconds = common::SecondsBetween(batch.started_at, now);
  Account& account = AccountOf(batch.windows.front().job);
  account.cost.Observe(batch.Frames(), seconds, now);
  account.served_seconds += seconds - batch.expected_seconds;
  running_.erase(batch.number);
  if (batch.windows.size() > 1) last_company_ = now;
}

std::vector<DroppedWindow> WindowQueue::DropAll(const absl::Status& reason, TimePoint now) {
  std::vector<DroppedWindow> dropped;
  std::vector<Decision::Drop> over = Decide(StateAt(now), options_.limits, now).dropped;
  for (Decision::Drop& drop : over) {
    dropped.push_back({TakeOut(drop.window), std::move(drop.reason)});
  }
  RemoveTaken();
  for (std::size_t i = 0; i < waiting_.size(); ++i) dropped.push_back({TakeOut(i), reason});
  RemoveTaken();
  return dropped;
}

WindowQueue::Account& WindowQueue::AccountOf(const WindowJob& job) {
  const auto found = accounts_.find(job.model.get());
  if (found != accounts_.end() && !found->second.model.expired()) return found->second;
  // Remove models that no longer exist; one of them may have had the same address.
  for (auto account = accounts_.begin(); account != accounts_.end();) {
    account = account->second.model.expired() ? accounts_.erase(account) : std::next(account);
  }
  Account& account = accounts_[job.model.get()];
  account.model = job.model;
  return account;
}

QueueState WindowQueue::StateAt(TimePoint now) const {
  QueueState state;
  std::map<const engine::Synthesizer*, std::size_t> index;
  for (const auto& [model, account] : accounts_) {
    index[model] = state.models.size();
    state.models.push_back({account.cost.At(now), account.served_seconds});
  }
  std::map<std::string_view, std::size_t> clients;
  state.windows.reserve(waiting_.size());
  for (const auto& [job, queued_at, frames] : waiting_) {
    const std::size_t client = clients.emplace(job.client, clients.size()).first->second;
    state.windows.push_back({index[job.model.get()], LaneOf(job), client, frames, queued_at,
                             job.deadline, IsCancelled(job), job.due});
  }
  state.overtaken_frames = overtaken_frames_;
  state.free_workers = options_.workers - static_cast<int>(running_.size());
  for (const auto& [number, end] : running_) state.busy_until.push_back(end);
  state.last_company = last_company_;
  state.last_short = last_short_;
  return state;
}

QueuedWindow WindowQueue::TakeOut(std::size_t index) {
  --AccountOf(waiting_[index].job).waiting;
  return std::exchange(waiting_[index], {});
}

void WindowQueue::RemoveTaken() {
  const auto taken = [](const QueuedWindow& window) { return window.job.model == nullptr; };
  waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), taken), waiting_.end());
}

void WindowQueue::CountOvertaking(const Batch& batch) {
  if (batch.windows.empty()) return;
  std::array<bool, kLanes> waits = {};
  for (const QueuedWindow& window : waiting_) {
    waits[static_cast<std::size_t>(LaneOf(window.job))] = true;
  }
  const auto served = static_cast<std::size_t>(LaneOf(batch.windows.front().job));
  const int frames = batch.Frames();
  overtaken_frames_[served] = std::max(0, overtaken_frames_[served] - kOvertaking * frames);
  for (std::size_t lane = served + 1; lane < kLanes; ++lane) {
    overtaken_frames_[lane] = waits[lane] ? overtaken_frames_[lane] + frames : 0;
  }
}

void WindowQueue::Start(Batch& batch, TimePoint now) {
  Account& account = AccountOf(batch.windows.front().job);
  batch.number = ++batches_;
  batch.started_at = now;
  batch.expected_seconds = account.cost.At(now).Seconds(batch.Frames());
  running_[batch.number] = After(now, batch.expected_seconds);
  served_by_now_ = std::max(served_by_now_, account.served_seconds);
  account.served_seconds += batch.expected_seconds;
}

}  // namespace duet::server::batching
