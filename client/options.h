#ifndef DUET_CLIENT_OPTIONS_H_
#define DUET_CLIENT_OPTIONS_H_

#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/time/time.h"

namespace duet::client {

// Options of an encrypted connection. Certificates and keys are PEM text, not paths.
struct TlsOptions {
  // Authorities that may sign the server's certificate. Empty: the system's authorities.
  std::string root_certificates;
  // This client's certificate and key, for servers that request one. Set both or neither.
  std::string certificate_chain;
  std::string private_key;
  // The name that the server's certificate must contain. Optional. Defaults to the host of the
  // address.
  std::string server_name;
};

// When a failed call is retried.
//
// The wait before attempt n + 1 is drawn from [0.5, 1] x min(max_backoff, initial_backoff x
// 2^(n-1)). It is never shorter than the delay in the server's RetryInfo. By default, retries stop
// at the deadline, or when the server has been unreachable for ClientOptions::wait.
struct RetryOptions {
  int max_attempts = std::numeric_limits<int>::max();  // 1: never retry
  absl::Duration initial_backoff = absl::Milliseconds(100);
  absl::Duration max_backoff = absl::Seconds(5);
  // Called before each wait, on the caller's thread. Optional.
  std::function<void(const absl::Status& why, absl::Duration wait)> on_wait;
};

// Options of a Client.
struct ClientOptions {
  // "host:port", or any gRPC target ("unix:/run/duet.sock", "ipv4:10.0.0.1:50051").
  // If a host name resolves to several servers, calls are distributed over all of them.
  std::string server_address = "localhost:50051";
  // Time limit of a call, including all its attempts.
  absl::Duration deadline = absl::Minutes(2);
  // Time for which a call retries an unreachable server (connection refused, unknown host name)
  // before it fails, limited by the deadline. 0: fail at once. A reachable server that is loading
  // or draining is retried until the deadline.
  absl::Duration wait = absl::Seconds(5);
  // Absent: plain text.
  std::optional<TlsOptions> tls;
  // Credentials of the caller, sent with every call as `authorization: Bearer TOKEN`. Empty: none.
  // Without `tls`, a token is allowed only for servers on this machine ("localhost:50051",
  // "127.0.0.1:50051", "unix:/run/duet.sock").
  std::string token;
  // The HTTP/2 authority that calls name. A proxy can route by it. With `tls`, the server's
  // certificate must contain it. Optional. Defaults to the address.
  std::string authority;
  RetryOptions retry;
  // True: do not share the TCP connection with other Clients of this process. Several connections
  // have a higher throughput than one.
  bool own_connection = false;
};

}  // namespace duet::client

#endif  // DUET_CLIENT_OPTIONS_H_
