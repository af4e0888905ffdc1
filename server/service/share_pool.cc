#include "server/service/share_pool.h"

#include <cstdlib>

namespace duet::server::service {

ShareLease::~ShareLease() {
  if (pool_ != nullptr) pool_->GiveBack(client_, amount_);
}

std::optional<ShareLease> SharePool::Take(const std::string& client, std::size_t amount) {
  common::MutexLock lock(mutex_);
  if (!MayTake(client, amount)) return std::nullopt;
  // No entries of zero: the first of several such leases would erase the entry of the others.
  if (amount == 0) return ShareLease();
  taken_ += amount;
  held_[client] += amount;
  return ShareLease(this, client, amount);
}

bool SharePool::MayTake(const std::string& client, std::size_t amount) const {
  const std::size_t free = amount_ - taken_;
  if (amount > free) return false;
  const auto found = held_.find(client);
  if (found == held_.end()) return true;
  // held < share / (1 - share) x free, without dividing by zero.
  return (1 - client_share_) * static_cast<double>(found->second) <
         client_share_ * static_cast<double>(free);
}

std::size_t SharePool::taken() const {
  common::MutexLock lock(mutex_);
  return taken_;
}

void SharePool::GiveBack(const std::string& client, std::size_t amount) {
  common::MutexLock lock(mutex_);
  const auto found = held_.find(client);
  if (found == held_.end() || found->second < amount) std::abort();  // a lease was returned twice
  taken_ -= amount;
  found->second -= amount;
  if (found->second == 0) held_.erase(found);
}

}  // namespace duet::server::service
