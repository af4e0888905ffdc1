#ifndef DUET_SERVER_SERVICE_LIVE_CALLS_H_
#define DUET_SERVER_SERVICE_LIVE_CALLS_H_

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
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

  virtual const std::string& client() const = 0;
  // Since when a message of the answer has waited for its reader; nothing while none is being
  // written.
  virtual std::optional<common::TimePoint> waiting_since() const = 0;
  // Ends the call if a message of its answer has waited for its reader for so long, and frees its
  // place at once. Returns the bytes of its request, which are free as soon as the call has ended;
  // nothing if no message has waited so long.
  virtual std::optional<std::size_t> GiveUpReader(common::TimePoint now, double seconds) = 0;
};

// All of them, without keeping them alive.
//
// Threads: safe to call concurrently.
class LiveCalls {
 public:
  void Add(const std::shared_ptr<LiveCall>& call);
  // Ends all calls, and every call that is added later.
  void AbortAll(const absl::Status& reason);
  void CheckTime(common::TimePoint now);

  // Gives up the reader that has kept a message waiting for longest, `seconds` or more: of this
  // client, or of any client if absent. Returns what LiveCall::GiveUpReader returned.
  std::optional<std::size_t> GiveUpSlowestReader(const std::optional<std::string>& client,
                                                 common::TimePoint now, double seconds);

 private:
  std::vector<std::shared_ptr<LiveCall>> All();

  common::Mutex mutex_;
  std::optional<absl::Status> ended_ DUET_GUARDED_BY(mutex_);  // why further calls end at once
  std::vector<std::weak_ptr<LiveCall>> calls_ DUET_GUARDED_BY(mutex_);
  std::size_t look_at_ DUET_GUARDED_BY(mutex_) = 64;  // calls at which the dead are taken out
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_LIVE_CALLS_H_
