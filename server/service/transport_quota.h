#ifndef DUET_SERVER_SERVICE_TRANSPORT_QUOTA_H_
#define DUET_SERVER_SERVICE_TRANSPORT_QUOTA_H_

#include <grpcpp/resource_quota.h>

#include <cstddef>

#include "server/common/mutex.h"

namespace duet::server::service {

// The memory that gRPC may use for requests being received.
//
// gRPC counts a request until its bytes are freed. It resets calls at random once its quota is used
// up, so requests that have come and wait to be parsed, for which there is room elsewhere
// (Admission::Hold), must not use up what is meant for requests being received.
//
// Threads: safe to call concurrently.
class TransportQuota {
 public:
  explicit TransportQuota(std::size_t bytes);

  // For a server's builder.
  const grpc::ResourceQuota& quota() const { return quota_; }

  // A request of `bytes` that has come, as long as its bytes exist.
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
