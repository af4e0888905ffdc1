#ifndef DUET_SERVER_SERVICE_LIVE_CALLS_H_
#define DUET_SERVER_SERVICE_LIVE_CALLS_H_

#include <cstddef>
#include <memory>
#include <vector>

#include "absl/status/status.h"
#include "server/common/clock.h"
#include "server/common/mutex.h"

namespace duet::server::service {

// A call between its headers and its status.
//
// Threads: safe to call concurrently.
class LiveCall {
 public:
  virtual ~LiveCall() = default;
  // Ends the call early, with its first reason.
  virtual void Abort(const absl::Status& reason) = 0;
  // Ends the call if it has taken longer than it may.
  virtual void CheckTime(common::TimePoint now) = 0;
};

// All of them, without keeping them alive.
//
// Threads: safe to call concurrently.
class LiveCalls {
 public:
  void Add(const std::shared_ptr<LiveCall>& call);
  void AbortAll(const absl::Status& reason);
  void CheckTime(common::TimePoint now);

 private:
  std::vector<std::shared_ptr<LiveCall>> All();

  common::Mutex mutex_;
  std::vector<std::weak_ptr<LiveCall>> calls_ DUET_GUARDED_BY(mutex_);
  std::size_t look_at_ DUET_GUARDED_BY(mutex_) = 64;  // calls at which the dead are taken out
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_LIVE_CALLS_H_
