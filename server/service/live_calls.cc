#include "server/service/live_calls.h"

#include <algorithm>

namespace duet::server::service {
namespace {

constexpr std::size_t kFewest = 64;

void RemoveDead(std::vector<std::weak_ptr<LiveCall>>& calls) {
  const auto dead = [](const std::weak_ptr<LiveCall>& call) { return call.expired(); };
  calls.erase(std::remove_if(calls.begin(), calls.end(), dead), calls.end());
}

}  // namespace

void LiveCalls::Add(const std::shared_ptr<LiveCall>& call) {
  common::MutexLock lock(mutex_);
  if (calls_.size() >= look_at_) {
    RemoveDead(calls_);
    // Seldom enough to cost each call little, however many are alive.
    look_at_ = std::max(kFewest, 2 * calls_.size());
  }
  calls_.push_back(call);
}

void LiveCalls::AbortAll(const absl::Status& reason) {
  for (const std::shared_ptr<LiveCall>& call : All()) call->Abort(reason);
}

void LiveCalls::CheckTime(common::TimePoint now) {
  for (const std::shared_ptr<LiveCall>& call : All()) call->CheckTime(now);
}

std::vector<std::shared_ptr<LiveCall>> LiveCalls::All() {
  std::vector<std::shared_ptr<LiveCall>> alive;
  common::MutexLock lock(mutex_);
  RemoveDead(calls_);
  alive.reserve(calls_.size());
  for (const std::weak_ptr<LiveCall>& weak : calls_) {
    if (std::shared_ptr<LiveCall> call = weak.lock()) alive.push_back(std::move(call));
  }
  return alive;
}

}  // namespace duet::server::service
