#include "server/batching/window_queue.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "model/engine/candidates.h"

namespace duet::server::batching {
namespace {

using common::TimePoint;

int CandidatesOf(const WindowJob& job) {
  return engine::EvaluationCount(job.model->description(), job.window.options.sampling);
}

int FramesOf(const WindowJob& job) { return job.window.leader.frame_count() * CandidatesOf(job); }

Lane LaneOf(const WindowJob& job) {
  return LaneOf(job.priority, job.call_windows * CandidatesOf(job), job.continues_call);
}

bool IsCancelled(const WindowJob& job) { return job.cancelled->load(std::memory_order_acquire); }

}  // namespace

int QueuedWindow::Turns() const { return TurnsOf(frames, job.model->description().window_frames); }

int Batch::Frames() const {
  int frames = 0;
  for (const QueuedWindow& window : windows) frames += window.frames;
  return frames;
}

int Batch::Candidates() const {
  int candidates = 0;
  for (const QueuedWindow& window : windows) candidates += window.candidates;
  return candidates;
}

bool WindowQueue::HasRoomFor(const WindowJob& job, TimePoint now) const {
  return job.continues_call || HasRoomFor(job.priority, job.client, now, CandidatesOf(job));
}

bool WindowQueue::HasRoomFor(Priority priority, const std::string& client, TimePoint now,
                             int candidates) const {
  const std::size_t most = ShareOf(capacity(), priority);
  std::size_t taken = 0, held = 0;
  for (const QueuedWindow& window : waiting_) {
    const WindowJob& job = window.job;
    if (job.continues_call || IsCancelled(job) || now >= job.deadline) continue;
    taken += static_cast<std::size_t>(window.candidates);
    if (job.client == client) held += static_cast<std::size_t>(window.candidates);
  }
  if (taken == 0) return true;
  if (taken + static_cast<std::size_t>(candidates) > most) return false;
  return held == 0 || (1 - options_.client_share) * static_cast<double>(held) <
                          options_.client_share * static_cast<double>(most - taken);
}

bool WindowQueue::ComesInTime(const WindowJob& job, TimePoint now) const {
  double work = 0, batch_seconds = 0;
  int windows = 0;
  for (const QueuedWindow& window : waiting_) {
    const WindowJob& waiting = window.job;
    if (LaneOf(waiting) > LaneOf(job) || IsCancelled(waiting) || now >= waiting.deadline) continue;
    const CostEstimate cost = CostOf(waiting, now);
    work += cost.frame_seconds * window.frames;
    batch_seconds = std::max(batch_seconds, cost.batch_seconds);
    windows += window.Turns();
  }
  if (windows == 0) return true;
  const int batches = (windows + options_.limits.max_windows - 1) / options_.limits.max_windows;
  work += batches * batch_seconds;
  for (const auto& [number, batch] : running_) {
    work += std::max(0.0, common::SecondsBetween(now, batch.end));
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
  const bool is_short = LaneOf(job) == Lane::kShort;
  LaneClients& clients = ClientsOf(job);
  ClientTurns& client =
      clients.waiting.emplace(job.client, ClientTurns{clients.turns_by_now}).first->second;
  ++client.waiting;
  const int frames = FramesOf(job), candidates = CandidatesOf(job);
  waiting_.push_back({std::move(job), now, frames, candidates});
  if (is_short) last_short_ = now;
  if (is_short && waiting_.back().Turns() <= kLightTurns) last_light_ = now;
}

Turn WindowQueue::Next(TimePoint now) {
  Decision decision = Decide(StateAt(now), options_.limits, now);
  Turn turn;
  turn.look_again = decision.look_again;
  for (Decision::Drop& drop : decision.dropped) {
    turn.dropped.push_back({TakeOut(drop.window), std::move(drop.reason)});
  }
  for (const std::size_t index : decision.batch) {
    CountTurns(waiting_[index]);
    turn.batch.windows.push_back(TakeOut(index));
  }
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

WindowQueue::LaneClients& WindowQueue::ClientsOf(const WindowJob& job) {
  return clients_[static_cast<std::size_t>(LaneOf(job))];
}

void WindowQueue::CountTurns(const QueuedWindow& window) {
  LaneClients& clients = ClientsOf(window.job);
  ClientTurns& client = clients.waiting[window.job.client];
  client.turns += window.Turns();
  clients.turns_by_now = std::max(clients.turns_by_now, client.turns);
}

std::size_t WindowQueue::candidates() const {
  std::size_t candidates = 0;
  for (const QueuedWindow& window : waiting_) {
    candidates += static_cast<std::size_t>(window.candidates);
  }
  return candidates;
}

QueueState WindowQueue::StateAt(TimePoint now) const {
  QueueState state;
  std::map<const engine::Synthesizer*, std::size_t> index;
  for (const auto& [model, account] : accounts_) {
    index[model] = state.models.size();
    const std::shared_ptr<const engine::Synthesizer> served = account.model.lock();
    state.models.push_back({account.cost.At(now), account.served_seconds,
                            served == nullptr ? 1 : served->description().window_frames});
  }
  std::map<std::string_view, std::size_t> clients;
  state.windows.reserve(waiting_.size());
  for (const QueuedWindow& window : waiting_) {
    const WindowJob& job = window.job;
    const Lane lane = LaneOf(job);
    const std::size_t client = clients.emplace(job.client, clients.size()).first->second;
    const std::int64_t turns =
        clients_[static_cast<std::size_t>(lane)].waiting.at(job.client).turns;
    state.windows.push_back({index[job.model.get()], lane, client, turns, window.frames,
                             window.queued_at, job.deadline, IsCancelled(job), job.due});
  }
  state.overtaken_frames = overtaken_frames_;
  state.free_workers = options_.workers - static_cast<int>(running_.size());
  for (const auto& [number, batch] : running_) {
    state.busy_until.push_back(batch.end);
    if (batch.is_heavy) ++state.heavy_batches;
  }
  state.last_company = last_company_;
  state.last_short = last_short_;
  state.last_light = last_light_;
  return state;
}

QueuedWindow WindowQueue::TakeOut(std::size_t index) {
  const WindowJob& job = waiting_[index].job;
  --AccountOf(job).waiting;
  std::map<std::string, ClientTurns>& clients = ClientsOf(job).waiting;
  const auto client = clients.find(job.client);
  if (--client->second.waiting == 0) clients.erase(client);
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
  const bool is_heavy =
      std::any_of(batch.windows.begin(), batch.windows.end(),
                  [](const QueuedWindow& window) { return window.Turns() > kLightTurns; });
  running_[batch.number] = {now + common::Seconds(batch.expected_seconds), is_heavy};
  served_by_now_ = std::max(served_by_now_, account.served_seconds);
  account.served_seconds += batch.expected_seconds;
}

}  // namespace duet::server::batching
