#ifndef DUET_SERVER_SERVICE_TRANSPORT_QUOTA_H_
#define DUET_SERVER_SERVICE_TRANSPORT_QUOTA_H_

#include <grpcpp/resource_quota.h>

#include <cstddef>

#include "server/common/mutex.h"

namespace duet::server::service {

// The memory that gRPC may use for requests being received.
//
// gRPC counts a request until its bytes are freed, and resets random calls when its quota is used
// up. Requests that have arrived and wait to be parsed are limited by Admission::Hold. This class
// therefore enlarges the quota by their size.
//
// Threads: safe to call concurrently.
class TransportQuota {
 public:
  explicit TransportQuota(std::size_t bytes);

  // The quota to pass to the server's builder.
  const grpc::ResourceQuota& quota() const { return quota_; }

  // Accounts for a request of `bytes` that has arrived, until its bytes are freed.
  class Received {
   public:
    Received(TransportQuota& quota, std::size_t bytes) : quota_(quota), bytes_(bytes) {
      quota_.Add(static_cast<std::ptrdiff_t>(bytes_));
    }
    ~Received() { quota_.Add(-static_cast<std::ptrdiff_t>(bytes_)); }
    Received(const Received&) = delete;
    Received& operator=(const Received&) = delete;

   private:
    TransportQuota& quota_;
    const std::size_t bytes_;
  };

 private:
  void Add(std::ptrdiff_t bytes);

  const std::size_t bytes_;
  common::Mutex mutex_;
  std::ptrdiff_t received_ DUET_GUARDED_BY(mutex_) = 0;
  grpc::ResourceQuota quota_;
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_TRANSPORT_QUOTA_H_
