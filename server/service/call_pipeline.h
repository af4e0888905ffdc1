#ifndef DUET_SERVER_SERVICE_CALL_PIPELINE_H_
#define DUET_SERVER_SERVICE_CALL_PIPELINE_H_

#include <grpcpp/server_context.h>

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "server/common/clock.h"
#include "server/metrics/call_record.h"
#include "server/security/access_control.h"

namespace duet::server::service {

// Returns the client of a gRPC peer string, such as "ipv4:192.0.2.7:4711" or "ipv6:%5B::1%5D:4711".
// Of an IPv6 address, only the network part (/64) is used, because one machine can have all
// addresses of its network.
std::string ClientOf(std::string_view peer);

bool IsTraceparent(std::string_view text);

// Returns 128 random bits in hexadecimal.
std::string NewRequestId();

// Returns the seconds until a call's deadline: negative if it has passed, infinite if there is
// none.
//
// Does not use the context's deadline(), which overflows for a timeout of 99,999,999 hours, the
// maximum of the wire format.
double SecondsLeft(const grpc::ServerContextBase& context);

// One call as its observers see it. Begins with the constructor and ends with Finish.
//
// Threads: not safe to call concurrently.
class CallScope {
 public:
  // `observers` and `clock` outlive the scope.
  CallScope(const metrics::MethodInfo& method, const std::vector<metrics::CallObserver*>& observers,
            const common::Clock& clock);

  // Filled in while the call runs.
  metrics::CallRecord& record() { return record_; }
  double ElapsedSeconds() const { return common::SecondsBetween(begin_, clock_.Now()); }

  void Finish(const absl::Status& status);

 private:
  const std::vector<metrics::CallObserver*>& observers_;
  const common::Clock& clock_;
  const common::TimePoint begin_;
  metrics::CallRecord record_;
};

// A call whose headers have arrived. Its message has not been read.
struct OpenedCall {
  std::unique_ptr<CallScope> scope;
  // Identifies the client for shared limits: a caller on the access list, else the client that a
  // trusted proxy names, else the peer's address without its port (ClientOf).
  std::string client;
  absl::Status status;  // OK, or the guard's error
};

// The steps that calls of every method have in common.
//
// In:   Open, at the headers: identity and scope (from here on the call is counted), access.
//       Admission follows, then the message (Call).
// Out:  Report: observers -> trailers, then the status. When a caller receives it, the metrics
//       already contain the call.
//
// Threads: const methods are safe to call concurrently.
class CallPipeline {
 public:
  // `client_key`: the metadata key in which a trusted proxy names its client; empty if there is
  // none. `access`: identifies callers by their certificate and their `authorization: Bearer
  // TOKEN`; null without an access list: then everybody may synthesise, and callers on this machine
  // may administer. `role`: required by every method. All arguments outlive the pipeline and its
  // calls.
  CallPipeline(std::string client_key, std::vector<metrics::CallObserver*> observers,
               const common::Clock& clock, const security::AccessControl* access,
               security::Role role)
      : client_key_(std::move(client_key)),
        observers_(std::move(observers)),
        clock_(clock),
        access_(access),
        role_(role) {}

  // Malformed metadata is ignored: a request ID must be one of model/base/request_id.h, and a
  // traceparent must have the W3C format. A call does not fail because of them, because a proxy may
  // have written them.
  OpenedCall Open(const grpc::ServerContextBase& context, const metrics::MethodInfo& method) const;

  // Reports a call that ends, and sets its trailers.
  static void Report(CallScope& scope, const absl::Status& status,
                     grpc::ServerContextBase& context);

 private:
  const std::string client_key_;
  const std::vector<metrics::CallObserver*> observers_;
  const common::Clock& clock_;
  const security::AccessControl* const access_;
  const security::Role role_;
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_CALL_PIPELINE_H_
