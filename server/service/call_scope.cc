#include "server/service/call_scope.h"

#include <utility>

namespace duet::server::service {

CallScope::CallScope(const metrics::MethodInfo& method, CallIdentity identity,
                     const std::vector<metrics::CallObserver*>& observers,
                     const common::Clock& clock)
    : observers_(observers), clock_(clock), begin_(clock.Now()) {
  record_.method = method;
  record_.request_id = std::move(identity.request_id);
  record_.traceparent = std::move(identity.traceparent);
  record_.peer = std::move(identity.peer);
  for (metrics::CallObserver* observer : observers_) observer->CallStarted(method);
}

void CallScope::Finish(const absl::Status& status) {
  record_.status = status;
  record_.total_seconds = ElapsedSeconds();
  for (metrics::CallObserver* observer : observers_) observer->CallFinished(record_);
}

}  // namespace duet::server::service
