#ifndef DUET_CLIENT_OPTIONS_H_
#define DUET_CLIENT_OPTIONS_H_

#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/time/time.h"

namespace duet::client {

// An encrypted connection. Every member is PEM text, not a path.
struct TlsOptions {
  // Who may sign the server's certificate. Empty: the system's authorities.
  std::string root_certificates;
  // This client's own certificate, for servers that ask for one. Both or neither.
  std::string certificate_chain;
  std::string private_key;
  // The name that the server's certificate must carry, where it is not the address. Optional.
  std::string server_name;
};

// How often and how patiently a call is attempted.
//
// The wait before attempt n + 1 is drawn from [0.5, 1] x min(max_backoff, initial_backoff x
// 2^(n-1)) and is never shorter than the RetryInfo that the server sent. Without a limit to their
// number, attempts end at the deadline, or when a server that cannot be reached has been away for
// ClientOptions::wait.
struct RetryOptions {
  int max_attempts = std::numeric_limits<int>::max();  // 1: never retry
  absl::Duration initial_backoff = absl::Milliseconds(100);
  absl::Duration max_backoff = absl::Seconds(5);
  // Told before each wait, on the caller's thread: why, and for how long. Optional.
  std::function<void(const absl::Status& why, absl::Duration wait)> on_wait;
};

// How a Client reaches its server.
struct ClientOptions {
  // "host:port", or any gRPC target ("unix:/run/duet.sock", "ipv4:10.0.0.1:50051").
  // A host name that resolves to several servers is balanced over all of them.
  std::string server_address = "localhost:50051";
  // For a whole call, all its attempts included.
  absl::Duration deadline = absl::Minutes(2);
  // How long a call retries a server that cannot be reached (refused connections, unknown host
  // names) before it fails; never past the deadline. 0: fail at once. A server that answers, even
  // to say that it is loading or draining, is retried until the deadline.
  absl::Duration wait = absl::Seconds(5);
  // Absent: plain text.
  std::optional<TlsOptions> tls;
  // Says who calls, as `authorization: Bearer TOKEN` of every call. Empty: nobody. Without `tls` it
  // goes to this machine alone ("localhost:50051", "127.0.0.1:50051", "unix:/run/duet.sock").
  std::string token;
  // What calls name as the server they are for, where it is not the address; a proxy may choose by
  // it. With `tls` the server's certificate must carry it. Optional.
  std::string authority;
  RetryOptions retry;
  // A connection that no other Client of this process shares: several carry more than one.
  bool own_connection = false;
};

}  // namespace duet::client

#endif  // DUET_CLIENT_OPTIONS_H_
