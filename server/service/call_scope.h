#ifndef DUET_SERVER_SERVICE_CALL_SCOPE_H_
#define DUET_SERVER_SERVICE_CALL_SCOPE_H_

#include <vector>

#include "absl/status/status.h"
#include "server/common/clock.h"
#include "server/metrics/call_record.h"
#include "server/service/call_identity.h"

namespace duet {

// One call as its observers see it: begun here, ended by Finish, once.
//
// Threads: not safe to call concurrently.
class CallScope {
 public:
  // Everything outlives the scope.
  CallScope(const MethodInfo& method, CallIdentity identity,
            const std::vector<CallObserver*>& observers, const Clock& clock);

  // Filled in as the call goes on.
  CallRecord& record() { return record_; }
  double ElapsedSeconds() const { return SecondsBetween(begin_, clock_.Now()); }

  void Finish(const absl::Status& status);

 private:
  const std::vector<CallObserver*>& observers_;
  const Clock& clock_;
  const TimePoint begin_;
  CallRecord record_;
};

}  // namespace duet

#endif  // DUET_SERVER_SERVICE_CALL_SCOPE_H_
