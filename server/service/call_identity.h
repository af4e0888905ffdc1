#ifndef DUET_SERVER_SERVICE_CALL_IDENTITY_H_
#define DUET_SERVER_SERVICE_CALL_IDENTITY_H_

#include <grpcpp/server_context.h>

#include <string>
#include <string_view>

namespace duet::server::service {

// By what a call is recognised in logs and traces.
struct CallIdentity {
  std::string request_id;   // the caller's x-request-id, or one made here
  std::string traceparent;  // W3C trace context, empty when absent or malformed
  std::string peer;
};

// Reads a call's metadata. What callers send is used only when it is well formed: a request id of
// 1 to 128 printable ASCII characters without spaces, a traceparent as the W3C writes it.
CallIdentity IdentifyCall(const grpc::ServerContextBase& context);

bool IsRequestId(std::string_view text);
bool IsTraceparent(std::string_view text);

// 128 random bits in hexadecimal.
std::string NewRequestId();

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_CALL_IDENTITY_H_
