#ifndef DUET_SERVER_COMMON_BINDABLE_H_
#define DUET_SERVER_COMMON_BINDABLE_H_

#include <string>

#include "absl/status/status.h"

namespace duet::server::common {

// Checks whether this process can listen on an address now. Binds a socket for a moment without
// listening, which does not disturb other listeners. Resolves `host` if it is a name. `host` has no
// brackets; port 0 is any free one.
//
// Fails with the reason as "expected ..., got ...; hint":
//   NOT_FOUND            the host name does not resolve
//   ALREADY_EXISTS       another socket listens there
//   PERMISSION_DENIED    this user may not use the port
//   FAILED_PRECONDITION  the address does not belong to this machine, or any other reason
absl::Status CheckBindable(const std::string& host, int port);

// Explains why listening on an address has just failed: UNAVAILABLE with CheckBindable's reason.
absl::Status ListenFailure(const std::string& host, int port);

}  // namespace duet::server::common

#endif  // DUET_SERVER_COMMON_BINDABLE_H_
