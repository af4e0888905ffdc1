#ifndef DUET_SERVER_SERVICE_ADMISSION_H_
#define DUET_SERVER_SERVICE_ADMISSION_H_

#include <grpcpp/resource_quota.h>

#include <atomic>
#include <cstddef>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/batching/window_scheduler.h"
#include "server/common/mutex.h"
#include "server/service/share_pool.h"

namespace duet::server::service {

struct AdmissionLimits {
  std::size_t max_calls = 1;  // concurrent calls
  // Serialized size of the requests of calls in progress.
  std::size_t max_held_bytes = std::size_t{1} << 40;
  // Concurrent requests that may arrive slowly.
  std::size_t max_slow_requests = 1024;
  double client_share = 1;  // see SharePool
};

// Limits what the server accepts: concurrent calls, the bytes of their requests, and requests that
// arrive slowly. Clients share each of these limits.
//
// Threads: safe to call concurrently.
class Admission {
 public:
  enum class State { kLoading, kServing, kDraining };

  explicit Admission(const AdmissionLimits& limits);

  void SetState(State state);
  State state() const;

  // Returns UNAVAILABLE with RetryInfo while the server is loading or draining.
  absl::Status CheckServing() const;

  // Takes a place among the concurrent Synthesize calls. Returns UNAVAILABLE like CheckServing, and
  // RESOURCE_EXHAUSTED with RetryInfo if there are too many calls, in total or of this client.
  absl::StatusOr<ShareLease> Admit(const std::string& client);

  // Checks that a call that has a place may keep it at this priority: bulk calls may use only part
  // of the places. Returns RESOURCE_EXHAUSTED with RetryInfo otherwise.
  absl::Status CheckShare(batching::Priority priority) const;

  // Reserves bytes for a request that has arrived. RESOURCE_EXHAUSTED with RetryInfo if too few are
  // left.
  absl::StatusOr<ShareLease> Hold(const std::string& client, std::size_t bytes);

  // Permits a request to arrive slowly. RESOURCE_EXHAUSTED with RetryInfo if too many do.
  absl::StatusOr<ShareLease> ArriveSlowly(const std::string& client);

  std::size_t calls() const { return places_.taken(); }
  std::size_t held_bytes() const { return bytes_.taken(); }

 private:
  // Held while a call is admitted and while state_ changes. Probes read the state without it.
  common::Mutex mutex_;
  std::atomic<State> state_{State::kLoading};
  SharePool places_;
  SharePool bytes_;
  SharePool slow_requests_;
};

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

#endif  // DUET_SERVER_SERVICE_ADMISSION_H_
