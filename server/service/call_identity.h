#ifndef DUET_SERVER_SERVICE_CALL_IDENTITY_H_
#define DUET_SERVER_SERVICE_CALL_IDENTITY_H_

#include <grpcpp/server_context.h>

#include <string>
#include <string_view>

namespace duet::server::service {

// Identifies a call in logs and traces.
struct CallIdentity {
  std::string request_id;   // the caller's x-request-id, or a generated one
  std::string traceparent;  // W3C trace context, empty when absent or malformed
  std::string peer;
  // Identifies the client for shared limits: the client that a trusted proxy names, or else the
  // peer's address without its port. Of an IPv6 address, only the network part (/64) is used,
  // because one machine can have all addresses of its network.
  std::string client;
};

// Reads a call's metadata. Malformed values are ignored: a request ID must be one of
// model/base/request_id.h, and a traceparent must have the W3C format. A call does not fail because
// of them, because a proxy may have written them.
//
// `client_key`: the metadata key in which a trusted proxy names its client; empty if there is none.
CallIdentity IdentifyCall(const grpc::ServerContextBase& context, const std::string& client_key);

// Returns the client of a gRPC peer string, such as "ipv4:192.0.2.7:4711" or "ipv6:%5B::1%5D:4711".
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

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_CALL_IDENTITY_H_
