#ifndef DUET_SERVER_SERVICE_CALL_PIPELINE_H_
#define DUET_SERVER_SERVICE_CALL_PIPELINE_H_

#include <google/protobuf/message.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/common/clock.h"
#include "server/common/grpc_status.h"
#include "server/metrics/call_record.h"
#include "server/security/call_guard.h"
#include "server/service/admission.h"
#include "server/service/call_scope.h"

namespace duet::server::service {

// A call that has come in, as far as the pipeline let it.
template <typename Request>
struct IncomingCall {
  std::unique_ptr<CallScope> scope;
  absl::Status status;  // OK, or the refusal of the first step that did not let it through
  Request request;      // when OK
  AdmissionSlot slot;   // when OK: its place among the calls being answered, where it takes one
};

// The one way into the service, whatever the method, and the one way out of it. What every call
// must pass has its place here, so that it is written once.
//
// In:   identity and scope (from here on the call is counted) -> guard -> size -> parser ->
//       admission.
//       The steps after a refusal are not taken.
// Out:  observers -> status and trailers for the wire. A caller that has its status finds the call
//       in the metrics.
//
// Threads: const methods are safe to call concurrently.
class CallPipeline {
 public:
  // `trace_ratio`: see ServiceParts. Everything outlives the pipeline and its calls.
  CallPipeline(std::size_t max_request_bytes, std::vector<metrics::CallObserver*> observers,
               const common::Clock& clock, security::CallGuard guard, security::Role role,
               std::optional<double> trace_ratio)
      : max_request_bytes_(max_request_bytes),
        observers_(std::move(observers)),
        clock_(clock),
        guard_(guard),
        role_(role),
        trace_ratio_(trace_ratio) {}

  // Begins a call. `admit` is the method's own last step: a StatusOr<AdmissionSlot> from
  // (const Request&); the slot is empty for a method whose calls are not limited in number.
  template <typename Request, typename Admit>
  IncomingCall<Request> Open(const grpc::ServerContextBase& context,
                             const metrics::MethodInfo& method, const grpc::ByteBuffer& bytes,
                             const Admit& admit) const {
    IncomingCall<Request> call;
    call.scope = OpenScope(context, method);
    call.status = call.scope->Enter(guard_.Admit(context, role_));
    if (call.status.ok()) call.status = Read(bytes, call.request);
    if (!call.status.ok()) return call;
    absl::StatusOr<AdmissionSlot> slot = admit(std::as_const(call.request));
    call.status = slot.status();
    if (slot.ok()) call.slot = *std::move(slot);
    return call;
  }

  // Ends a call: reports it, then gives its status to `reactor`, of whatever kind.
  template <typename Reactor>
  static void Close(CallScope& scope, const absl::Status& status, grpc::ServerContextBase& context,
                    Reactor& reactor) {
    scope.Finish(status);
    common::AddRetryPushback(status, context);
    AddTraceparent(scope, context);
    reactor.Finish(common::ToGrpcStatus(status));
  }

 private:
  // Tells the caller under which span the call is known here.
  static void AddTraceparent(CallScope& scope, grpc::ServerContextBase& context);
  std::unique_ptr<CallScope> OpenScope(const grpc::ServerContextBase& context,
                                       const metrics::MethodInfo& method) const;
  // RESOURCE_EXHAUSTED when the bytes are too many, INVALID_ARGUMENT when they are no such message.
  absl::Status Read(const grpc::ByteBuffer& bytes, google::protobuf::Message& request) const;

  const std::size_t max_request_bytes_;
  const std::vector<metrics::CallObserver*> observers_;
  const common::Clock& clock_;
  const security::CallGuard guard_;
  const security::Role role_;  // that every method asks for
  const std::optional<double> trace_ratio_;
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_CALL_PIPELINE_H_
