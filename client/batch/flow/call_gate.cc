#include "client/batch/flow/call_gate.h"

namespace duet::client::batch::flow {

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
