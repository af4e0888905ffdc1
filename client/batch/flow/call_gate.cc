#include "client/batch/flow/call_gate.h"

#include <algorithm>

namespace duet::client::batch::flow {

int64_t CallWindow::Start() {
  ++in_flight_;
  return started_++;
}

void CallWindow::Close(Duration wait, Time now) { opens_ = std::max(opens_, now + wait); }

void CallWindow::Finish(int64_t call, CallEnd end, std::optional<Duration> delay, Time now) {
  const bool was_full = in_flight_ >= limit();
  --in_flight_;
  if (end == CallEnd::kAnswered) {
    failures_ = 0;
    if (was_full) window_ += slow_start_ ? 1 : 1 / window_;
    window_ = std::min(window_, static_cast<double>(options_.max_in_flight));
    return;
  }
  slow_start_ = false;
  if (delay.has_value()) Close(*delay, now);
  // Failures of calls that started before the window shrank do not shrink it again.
  const bool counts = call >= counted_from_;
  if (counts) counted_from_ = started_;
  if (end == CallEnd::kRefused) {
    if (counts) window_ = std::max(1.0, window_ / 2);
    if (!delay.has_value()) Close(options_.first_backoff, now);
    return;
  }
  window_ = 1;
  if (!counts) return;
  Close(std::min(options_.longest_backoff, options_.first_backoff * (1 << std::min(failures_, 16))),
        now);
  ++failures_;
}

std::optional<ServerChoice::Call> ServerChoice::Start(Time now) {
  std::optional<size_t> best;
  int most_room = 0;
  for (size_t i = 1; i <= windows_.size(); ++i) {
    const size_t server = (last_ + i) % windows_.size();
    const CallWindow& window = windows_[server];
    const int room = window.limit() - window.in_flight();
    if (!window.MayStart(now) || room <= most_room) continue;
    best = server;
    most_room = room;
  }
  if (!best.has_value()) return std::nullopt;
  last_ = *best;
  return Call{static_cast<int>(*best), windows_[*best].Start()};
}

void ServerChoice::Finish(const Call& call, CallEnd end, std::optional<Duration> delay, Time now) {
  windows_[static_cast<size_t>(call.server)].Finish(call.number, end, delay, now);
}

std::optional<Time> ServerChoice::NextOpening(Time now) const {
  std::optional<Time> next;
  for (const CallWindow& window : windows_) {
    if (window.in_flight() >= window.limit() || window.opens() <= now) continue;
    next = std::min(next.value_or(window.opens()), window.opens());
  }
  return next;
}

int ServerChoice::in_flight() const {
  int sum = 0;
  for (const CallWindow& window : windows_) sum += window.in_flight();
  return sum;
}

int ServerChoice::limit() const {
  int sum = 0;
  for (const CallWindow& window : windows_) sum += window.limit();
  return sum;
}

bool ServerChoice::HasRoom() const {
  return std::any_of(windows_.begin(), windows_.end(),
                     [](const CallWindow& window) { return window.in_flight() < window.limit(); });
}

bool ServerChoice::all_away() const {
  return std::all_of(windows_.begin(), windows_.end(),
                     [](const CallWindow& window) { return window.away(); });
}

std::optional<ServerChoice::Call> CallGate::Start() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopped_) {
    const Time now = std::chrono::steady_clock::now();
    std::optional<ServerChoice::Call> call = servers_.Start(now);
    if (call.has_value()) {
      // Wakes one more thread if a window has room for a call, now or after a delay.
      if (servers_.HasRoom()) changed_.notify_one();
      return call;
    }
    const std::optional<Time> opening = servers_.NextOpening(now);
    if (opening.has_value()) {
      changed_.wait_until(lock, *opening);
    } else {
      changed_.wait(lock);
    }
  }
  return std::nullopt;
}

void CallGate::Finish(const ServerChoice::Call& call, CallEnd end, std::optional<Duration> delay) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Time now = std::chrono::steady_clock::now();
  servers_.Finish(call, end, delay, now);
  if (end == CallEnd::kRefused) ++refusals_;
  if (!servers_.all_away()) {
    away_since_.reset();
  } else if (!away_since_.has_value()) {
    away_since_ = now;
  } else if (now - *away_since_ >= patience_) {
    lost_patience_ = stopped_ = true;
    changed_.notify_all();
  }
  changed_.notify_one();
}

void CallGate::Stop() {
  const std::lock_guard<std::mutex> lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
}

CallGate::State CallGate::state() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {servers_.in_flight(), servers_.limit(), refusals_, lost_patience_};
}

}  // namespace duet::client::batch::flow
