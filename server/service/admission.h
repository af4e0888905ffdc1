#ifndef DUET_SERVER_SERVICE_ADMISSION_H_
#define DUET_SERVER_SERVICE_ADMISSION_H_

#include <atomic>
#include <cstddef>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/batching/priority.h"
#include "server/common/mutex.h"
#include "server/service/share_pool.h"

namespace duet::server::service {

struct AdmissionLimits {
  std::size_t max_calls = 1;  // answered at the same time
  // Bytes of the requests of calls being answered, as they came.
  std::size_t max_held_bytes = std::size_t{1} << 40;
  // Requests that take long to arrive, at the same time.
  std::size_t max_slow_requests = 1024;
  double client_share = 1;  // see SharePool
};

// Decides what the server takes on: calls, the bytes of their requests, and how many requests may
// be long on their way. Each is shared among clients.
//
// Threads: safe to call concurrently.
class Admission {
 public:
  enum class State { kLoading, kServing, kDraining };

  explicit Admission(const AdmissionLimits& limits);

  void SetState(State state);
  State state() const;

  // Whether new calls are answered at all: UNAVAILABLE with RetryInfo while loading or draining.
  absl::Status CheckServing() const;

  // A place among the Synthesize calls being answered. UNAVAILABLE as above; RESOURCE_EXHAUSTED
  // with RetryInfo when there are too many calls, altogether or of this client.
  absl::StatusOr<ShareLease> Admit(const std::string& client);

  // Whether a call that has its place may keep it as work of this priority: bulk calls may fill
  // their share of the places. RESOURCE_EXHAUSTED as above.
  absl::Status CheckShare(batching::Priority priority) const;

  // Room for a request that has come. RESOURCE_EXHAUSTED with RetryInfo when there is none.
  absl::StatusOr<ShareLease> Hold(const std::string& client, std::size_t bytes);

  // Leave for a request to take its time to arrive. RESOURCE_EXHAUSTED with RetryInfo.
  absl::StatusOr<ShareLease> ArriveSlowly(const std::string& client);

  std::size_t calls() const { return places_.taken(); }
  std::size_t max_calls() const { return places_.amount(); }
  std::size_t held_bytes() const { return bytes_.taken(); }

 private:
  // Held while a call is admitted and while state_ changes. Probes read the state without it.
  common::Mutex mutex_;
  std::atomic<State> state_{State::kLoading};
  SharePool places_;
  SharePool bytes_;
  SharePool slow_requests_;
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_ADMISSION_H_
