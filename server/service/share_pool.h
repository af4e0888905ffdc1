#ifndef DUET_SERVER_SERVICE_SHARE_POOL_H_
#define DUET_SERVER_SERVICE_SHARE_POOL_H_

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "server/common/mutex.h"

namespace duet::server::service {

class SharePool;

// A part of a pool that a client holds. The destructor returns it.
class ShareLease {
 public:
  ShareLease() = default;
  ShareLease(ShareLease&& other) noexcept
      : pool_(std::exchange(other.pool_, nullptr)),
        client_(std::move(other.client_)),
        amount_(other.amount_) {}
  ShareLease& operator=(ShareLease&& other) noexcept {
    std::swap(pool_, other.pool_);
    std::swap(client_, other.client_);
    std::swap(amount_, other.amount_);
    return *this;
  }
  ~ShareLease();

  explicit operator bool() const { return pool_ != nullptr; }

 private:
  friend class SharePool;
  ShareLease(SharePool* pool, std::string client, std::size_t amount)
      : pool_(pool), client_(std::move(client)), amount_(amount) {}

  SharePool* pool_ = nullptr;
  std::string client_;
  std::size_t amount_ = 0;
};

// A resource that clients share: places, bytes.
//
// A client may take more while it holds less than client_share / (1 - client_share) times the free
// amount. A single client can therefore hold client_share of the whole; two clients with a share of
// 3/4 can hold 3/7 each. A new client always finds a free amount, and the number of clients need
// not be known in advance (Choudhury and Hahne 1998, "Dynamic queue length thresholds for
// shared-memory packet switches").
//
// Threads: safe to call concurrently.
class SharePool {
 public:
  // `client_share`: in (0, 1]. With 1, one client may hold everything.
  SharePool(std::size_t amount, double client_share)
      : amount_(amount), client_share_(client_share) {}

  // Returns nullopt if `amount` is not free, or if the client already holds its share. A lease of 0
  // is empty and converts to false. The lease must not outlive the pool.
  std::optional<ShareLease> Take(const std::string& client, std::size_t amount = 1);

  std::size_t amount() const { return amount_; }
  std::size_t taken() const;

 private:
  friend class ShareLease;
  bool MayTake(const std::string& client, std::size_t amount) const DUET_REQUIRES(mutex_);
  void GiveBack(const std::string& client, std::size_t amount);

  const std::size_t amount_;
  const double client_share_;
  mutable common::Mutex mutex_;
  std::size_t taken_ DUET_GUARDED_BY(mutex_) = 0;
  std::map<std::string, std::size_t> held_ DUET_GUARDED_BY(mutex_);  // never an entry of 0
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_SHARE_POOL_H_
