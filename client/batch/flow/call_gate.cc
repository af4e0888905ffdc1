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

std::optional<int64_t> CallGate::Start() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopped_) {
    const Time now = std::chrono::steady_clock::now();
    const bool has_room = window_.in_flight() < window_.limit();
    if (has_room && now >= window_.opens()) {
      const int64_t call = window_.Start();
      // Wakes one more thread if there is room for another call.
      if (window_.in_flight() < window_.limit()) changed_.notify_one();
      return call;
    }
    if (has_room) {
      changed_.wait_until(lock, window_.opens());
    } else {
      changed_.wait(lock);
    }
  }
  return std::nullopt;
}

void CallGate::Finish(int64_t call, CallEnd end, std::optional<Duration> delay) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Time now = std::chrono::steady_clock::now();
  window_.Finish(call, end, delay, now);
  if (end == CallEnd::kRefused) ++refusals_;
  if (!window_.away()) {
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
  return {window_.in_flight(), window_.limit(), refusals_, lost_patience_};
}

}  // namespace duet::client::batch::flow
