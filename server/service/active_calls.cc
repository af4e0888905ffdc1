#include "server/service/active_calls.h"

#include <algorithm>
#include <chrono>

namespace duet::server::service {
namespace {

constexpr std::size_t kFewest = 64;

void RemoveDead(std::vector<std::weak_ptr<ActiveCall>>& calls) {
  const auto dead = [](const std::weak_ptr<ActiveCall>& call) { return call.expired(); };
  calls.erase(std::remove_if(calls.begin(), calls.end(), dead), calls.end());
}

}  // namespace

void ActiveCalls::Add(const std::shared_ptr<ActiveCall>& call) {
  std::optional<absl::Status> ended;
  bool draining = false;
  {
    common::MutexLock lock(mutex_);
    if (calls_.size() >= look_at_) {
      RemoveDead(calls_);
      // Seldom enough to cost each call little, however many are alive.
      look_at_ = std::max(kFewest, 2 * calls_.size());
    }
    calls_.push_back(call);
    ended = ended_;
    draining = draining_;
  }
  if (draining) call->Drain();
  if (ended) call->Abort(*ended);
}

void ActiveCalls::Drain() {
  {
    // A call that was admitted before the drain began may be added after this.
    common::MutexLock lock(mutex_);
    draining_ = true;
  }
  for (const std::shared_ptr<ActiveCall>& call : All()) call->Drain();
}

void ActiveCalls::AbortAll(const absl::Status& reason) {
  {
    // A call that was admitted before the server stopped admitting calls may be added after this.
    common::MutexLock lock(mutex_);
    ended_ = reason;
  }
  for (const std::shared_ptr<ActiveCall>& call : All()) call->Abort(reason);
}

void ActiveCalls::CheckTime(common::TimePoint now) {
  for (const std::shared_ptr<ActiveCall>& call : All()) call->CheckTime(now);
}

std::optional<std::size_t> ActiveCalls::GiveUpSlowestReader(
    const std::optional<std::string>& client, common::TimePoint now, double seconds) {
  for (const std::shared_ptr<ActiveCall>& call : LongestFirst(client, &ActiveCall::waiting_since)) {
    const std::optional<std::size_t> held = call->GiveUpReader(now, seconds);
    if (held.has_value()) return held;
  }
  return std::nullopt;
}

bool ActiveCalls::GiveUpLongestIdle(const std::string& client, common::TimePoint now,
                                    double seconds) {
  const Calls idle = LongestFirst(client, &ActiveCall::idle_since);
  return std::any_of(idle.begin(), idle.end(), [&](const std::shared_ptr<ActiveCall>& call) {
    return call->GiveUpIdle(now, seconds);
  });
}

ActiveCalls::Calls ActiveCalls::LongestFirst(const std::optional<std::string>& client,
                                             Since since) {
  using Waiting = std::pair<common::TimePoint, std::shared_ptr<ActiveCall>>;
  std::vector<Waiting> waiting;
  for (std::shared_ptr<ActiveCall>& call : All()) {
    if (client.has_value() && call->client() != *client) continue;
    const std::optional<common::TimePoint> begin = (*call.*since)();
    if (begin.has_value()) waiting.emplace_back(*begin, std::move(call));
  }
  std::sort(waiting.begin(), waiting.end(),
            [](const Waiting& a, const Waiting& b) { return a.first < b.first; });
  Calls calls;
  calls.reserve(waiting.size());
  for (Waiting& each : waiting) calls.push_back(std::move(each.second));
  return calls;
}

ActiveCalls::Calls ActiveCalls::All() {
  Calls alive;
  common::MutexLock lock(mutex_);
  RemoveDead(calls_);
  alive.reserve(calls_.size());
  for (const std::weak_ptr<ActiveCall>& weak : calls_) {
    if (std::shared_ptr<ActiveCall> call = weak.lock()) alive.push_back(std::move(call));
  }
  return alive;
}

void OpenCalls::Add(int calls) {
  common::MutexLock lock(mutex_);
  open_ += calls;
  if (open_ == 0) changed_.NotifyAll();
}

void OpenCalls::WaitForNone(double seconds) {
  const auto end = std::chrono::steady_clock::now() +
                   std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                       std::chrono::duration<double>(seconds));
  common::MutexLock lock(mutex_);
  while (open_ > 0 && changed_.WaitUntil(mutex_, end)) {
  }
}

}  // namespace duet::server::service
