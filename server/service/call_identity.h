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
  // By what clients are told apart where they share something: what a proxy in front calls its
  // client, or else the peer's address without its port (of IPv6 the network's part, which one
  // machine has for itself).
  std::string client;
};

// Reads a call's metadata. What callers send is used only when it is well formed: a request id of
// 1 to 128 printable ASCII characters without spaces, a traceparent as the W3C writes it.
//
// `client_key`: the metadata key under which a trusted proxy names its client; empty without one.
CallIdentity IdentifyCall(const grpc::ServerContextBase& context, const std::string& client_key);

// The client of a peer as gRPC writes it, such as "ipv4:192.0.2.7:4711" or "ipv6:%5B::1%5D:4711".
std::string ClientOf(std::string_view peer);

bool IsRequestId(std::string_view text);
bool IsTraceparent(std::string_view text);

// 128 random bits in hexadecimal.
std::string NewRequestId();

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_CALL_IDENTITY_H_
