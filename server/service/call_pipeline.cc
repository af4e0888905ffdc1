#include "server/service/call_pipeline.h"

#include <algorithm>
#include <string>
#include <utility>

#include "server/common/activity.h"
#include "server/common/trace_context.h"
#include "server/service/call_identity.h"
#include "server/service/refusals.h"
#include "server/service/wire.h"

namespace duet::server::service {

OpenedCall CallPipeline::Open(const grpc::ServerContextBase& context,
                              const metrics::MethodInfo& method) const {
  CallIdentity identity = IdentifyCall(context, client_key_);
  OpenedCall opened;
  opened.client = identity.client;
  opened.scope = std::make_unique<CallScope>(method, std::move(identity), observers_, clock_);
  metrics::CallRecord& record = opened.scope->record();
  if (auto trace = common::ContinueTrace(record.traceparent)) {
    record.trace = *std::move(trace);
  } else if (trace_ratio_.has_value()) {
    record.trace = common::BeginTrace(*trace_ratio_);
  }
  opened.status = opened.scope->Enter(guard_.Admit(context, role_));
  // A listed caller is one client, whatever address it calls from.
  if (record.caller_is_listed) opened.client = "caller:" + record.caller;
  return opened;
}

void CallPipeline::Report(CallScope& scope, const absl::Status& status,
                          grpc::ServerContextBase& context) {
  scope.Finish(status);
  common::AddRetryPushback(status, context);
  // The caller learns the span of the call on this server.
  const std::string traceparent = common::Traceparent(scope.record().trace);
  if (!traceparent.empty()) context.AddTrailingMetadata("traceparent", traceparent);
}

absl::Status CallPipeline::CheckSize(const grpc::ByteBuffer& bytes, std::size_t max_bytes) const {
  const std::size_t length = bytes.Length();
  if (length > max_request_bytes_) return TooLargeRefusal(length, max_request_bytes_);
  if (length > max_bytes) return LiveMessageTooLargeRefusal(length, max_bytes);
  return absl::OkStatus();
}

// By value, so that the bytes are freed as soon as they are parsed.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
absl::Status CallPipeline::Read(grpc::ByteBuffer bytes, google::protobuf::Message& request) const {
  const absl::Status fits = CheckSize(bytes);
  return fits.ok() ? ParseMessage(std::move(bytes), request) : fits;
}

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
