#ifndef DUET_SERVER_SERVICE_CALL_PIPELINE_H_
#define DUET_SERVER_SERVICE_CALL_PIPELINE_H_

#include <google/protobuf/message.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "server/common/clock.h"
#include "server/common/grpc_status.h"
#include "server/metrics/call_record.h"
#include "server/security/call_guard.h"
#include "server/service/call_scope.h"

namespace duet::server::service {

// A call whose headers have come. Its message has not been read.
struct OpenedCall {
  std::unique_ptr<CallScope> scope;
  std::string client;   // see CallIdentity; of a caller on the access list, that caller
  absl::Status status;  // OK, or why the guard turned it away
};

// The one way into the service, whatever the method, and the one way out of it. What every call
// must pass has its place here, so that it is written once.
//
// In:   Open, at the headers: identity and scope (from here on the call is counted), guard.
//       Admission comes next, then the message (Reception). Read: size -> bounds -> parser.
// Out:  Close: observers -> status and trailers for the wire. A caller that has its status finds
//       the call in the metrics.
//
// Threads: const methods are safe to call concurrently.
class CallPipeline {
 public:
  // `client_key`: see IdentifyCall; `trace_ratio`: see ServiceParts; `role`: what every method asks
  // for. Everything outlives the pipeline and its calls.
  CallPipeline(std::size_t max_request_bytes, std::string client_key,
               std::vector<metrics::CallObserver*> observers, const common::Clock& clock,
               security::CallGuard guard, security::Role role, std::optional<double> trace_ratio)
      : max_request_bytes_(max_request_bytes),
        client_key_(std::move(client_key)),
        observers_(std::move(observers)),
        clock_(clock),
        guard_(guard),
        role_(role),
        trace_ratio_(trace_ratio) {}

  OpenedCall Open(const grpc::ServerContextBase& context, const metrics::MethodInfo& method) const;

  // RESOURCE_EXHAUSTED when the bytes are too many.
  absl::Status CheckSize(const grpc::ByteBuffer& bytes) const;
  // RESOURCE_EXHAUSTED when the bytes are too many, INVALID_ARGUMENT when they are no such message
  // or one that would be too large when parsed. The bytes are let go of in any case.
  absl::Status Read(grpc::ByteBuffer bytes, google::protobuf::Message& request) const;

  // Reports a call that ends, and leaves its trailers for the wire.
  static void Report(CallScope& scope, const absl::Status& status,
                     grpc::ServerContextBase& context);
  // Ends a call: reports it, then gives its status to `reactor`, of whatever kind.
  template <typename Reactor>
  static void Close(CallScope& scope, const absl::Status& status, grpc::ServerContextBase& context,
                    Reactor& reactor) {
    Report(scope, status, context);
    reactor.Finish(common::ToGrpcStatus(status));
  }

 private:
  const std::size_t max_request_bytes_;
  const std::string client_key_;
  const std::vector<metrics::CallObserver*> observers_;
  const common::Clock& clock_;
  const security::CallGuard guard_;
  const security::Role role_;
  const std::optional<double> trace_ratio_;
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_CALL_PIPELINE_H_
