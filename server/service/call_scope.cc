#include "server/service/call_scope.h"

#include <utility>

#include "server/common/activity.h"

namespace duet::server::service {

CallScope::CallScope(const metrics::MethodInfo& method, CallIdentity identity,
                     const std::vector<metrics::CallObserver*>& observers,
                     const common::Clock& clock)
    : observers_(observers), clock_(clock), begin_(clock.Now()) {
  record_.method = method;
  record_.request_id = std::move(identity.request_id);
  record_.traceparent = std::move(identity.traceparent);
  record_.peer = std::move(identity.peer);
  ++common::ProcessVitals().calls;
  for (metrics::CallObserver* observer : observers_) observer->CallStarted(method);
}

absl::Status CallScope::Enter(security::CallPass pass) {
  pass_ = std::move(pass);
  record_.caller = pass_.name();
  record_.caller_is_listed = pass_.is_listed();
  return pass_.status();
}

void CallScope::Finish(const absl::Status& status) {
  // A caller that has its status has its share as well.
  pass_.Release();
  record_.status = status;
  record_.total_seconds = ElapsedSeconds();
  for (metrics::CallObserver* observer : observers_) observer->CallFinished(record_);
  --common::ProcessVitals().calls;
}

}  // namespace duet::server::service
