#ifndef DUET_SERVER_SERVICE_ACTIVE_CALLS_H_
#define DUET_SERVER_SERVICE_ACTIVE_CALLS_H_

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
class ActiveCall {
 public:
  virtual ~ActiveCall() = default;
  // The server begins to drain. Calls that have no end of their own notify their callers.
  virtual void Drain() = 0;
  // Ends the call early. The first reason counts.
  virtual void Abort(const absl::Status& reason) = 0;
  // Ends the call if a time limit has passed.
  virtual void CheckTime(common::TimePoint now) = 0;

  virtual const std::string& client() const = 0;
  // Since when a reply has waited for its reader. Absent if no reply is being written.
  virtual std::optional<common::TimePoint> waiting_since() const = 0;
  // If a reply has waited for its reader for `seconds`, ends the call, frees its place at once, and
  // returns the size of its request in bytes, which are free when the call has ended. Returns
  // nullopt otherwise.
  virtual std::optional<std::size_t> GiveUpReader(common::TimePoint now, double seconds) = 0;

  // Since when the call has waited for a further message of its caller, to whom it owes nothing.
  // Absent if it does not wait.
  virtual std::optional<common::TimePoint> idle_since() const = 0;
  // If the call has been idle for `seconds`, ends it, frees its place, and returns true.
  virtual bool GiveUpIdle(common::TimePoint now, double seconds) = 0;
};

// All active calls. Does not keep them alive.
//
// Threads: safe to call concurrently.
class ActiveCalls {
 public:
  void Add(const std::shared_ptr<ActiveCall>& call);
  // Notifies all calls, and every call that is added later, that the server drains.
  void Drain();
  // Ends all calls, and every call that is added later.
  void AbortAll(const absl::Status& reason);
  void CheckTime(common::TimePoint now);

  // Calls GiveUpReader for the call whose reader has kept a reply waiting longest, at least
  // `seconds`: of this client, or of any client if absent. Returns its result.
  std::optional<std::size_t> GiveUpSlowestReader(const std::optional<std::string>& client,
                                                 common::TimePoint now, double seconds);
  // Calls GiveUpIdle for the call of this client that has been idle longest, at least `seconds`.
  // Returns its result.
  bool GiveUpLongestIdle(const std::string& client, common::TimePoint now, double seconds);

 private:
  using Calls = std::vector<std::shared_ptr<ActiveCall>>;
  using Since = std::optional<common::TimePoint> (ActiveCall::*)() const;

  // The calls of a client, or of any client if absent, for which `since` is present: the earliest
  // first.
  Calls LongestFirst(const std::optional<std::string>& client, Since since);
  Calls All();

  common::Mutex mutex_;
  bool draining_ DUET_GUARDED_BY(mutex_) = false;
  std::optional<absl::Status> ended_ DUET_GUARDED_BY(mutex_);  // why calls added later end at once
  std::vector<std::weak_ptr<ActiveCall>> calls_ DUET_GUARDED_BY(mutex_);
  std::size_t look_at_ DUET_GUARDED_BY(mutex_) =
      64;  // number of calls at which ended ones are removed
};

// Counts the calls that gRPC has not finished. Their status may not have been sent yet.
//
// Threads: safe to call concurrently.
class OpenCalls {
 public:
  // Counts one call during its lifetime.
  class Ticket {
   public:
    explicit Ticket(OpenCalls& calls) : calls_(calls) { calls_.Add(1); }
    ~Ticket() { calls_.Add(-1); }
    Ticket(const Ticket&) = delete;
    Ticket& operator=(const Ticket&) = delete;

   private:
    OpenCalls& calls_;
  };

  // Waits until there are none, at most `seconds`.
  void WaitForNone(double seconds);

 private:
  void Add(int calls);

  common::Mutex mutex_;
  common::CondVar changed_;
  int open_ DUET_GUARDED_BY(mutex_) = 0;
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_ACTIVE_CALLS_H_
