#ifndef DUET_SERVER_SERVICE_CALL_SCOPE_H_
#define DUET_SERVER_SERVICE_CALL_SCOPE_H_

#include <cstdint>
#include <vector>

#include "absl/status/status.h"
#include "server/common/clock.h"
#include "server/metrics/call_record.h"
#include "server/security/call_guard.h"
#include "server/service/call_identity.h"

namespace duet::server::service {

// One call as its observers see it. Begins with the constructor and ends with Finish.
//
// Threads: not safe to call concurrently.
class CallScope {
 public:
  // `observers` and `clock` outlive the scope.
  CallScope(const metrics::MethodInfo& method, CallIdentity identity,
            const std::vector<metrics::CallObserver*>& observers, const common::Clock& clock);

  // Keeps the guard's pass until Finish, and returns its status: OK if the call may proceed.
  absl::Status Enter(security::CallPass pass);
  // Takes frames from the caller's quota. Returns RESOURCE_EXHAUSTED if too few are left.
  absl::Status HoldFrames(std::int64_t frames) { return pass_.HoldFrames(frames); }

  // Filled in while the call runs.
  metrics::CallRecord& record() { return record_; }
  double ElapsedSeconds() const { return common::SecondsBetween(begin_, clock_.Now()); }

  void Finish(const absl::Status& status);

 private:
  const std::vector<metrics::CallObserver*>& observers_;
  const common::Clock& clock_;
  const common::TimePoint begin_;
  metrics::CallRecord record_;
  security::CallPass pass_;
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_CALL_SCOPE_H_
