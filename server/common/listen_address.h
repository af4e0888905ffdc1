#ifndef DUET_SERVER_COMMON_LISTEN_ADDRESS_H_
#define DUET_SERVER_COMMON_LISTEN_ADDRESS_H_

#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace duet::server::common {

// A host and a port to listen on.
struct ListenAddress {
  std::string host;
  int port = 0;  // 0: any free one
};

// Parses "host:port". An IPv6 host is in brackets; an empty host means every interface.
// Fails with INVALID_ARGUMENT.
absl::StatusOr<ListenAddress> ParseListenAddress(const std::string& text);
std::string ToString(const ListenAddress& address);

// The address of a resolved setting; nullopt for "off".
std::optional<ListenAddress> AddressOf(const std::string& setting);

// Whether two listeners cannot exist at the same time.
bool Clash(const ListenAddress& a, const ListenAddress& b);

// Checks whether this process can listen on an address now. Binds a socket for a moment without
// listening, which does not disturb other listeners. Resolves `host` if it is a name. `host` has no
// brackets; port 0 is any free one.
//
// Fails with the reason as "expected ..., got ...; hint":
//   NOT_FOUND            the host name does not resolve
//   ALREADY_EXISTS       another socket listens there
//   FAILED_PRECONDITION  the address does not belong to this machine, this user may not use the
//                        port, or any other reason
absl::Status CheckBindable(const std::string& host, int port);

// Explains why listening on an address has just failed: UNAVAILABLE with CheckBindable's reason.
absl::Status ListenFailure(const std::string& host, int port);

}  // namespace duet::server::common

#endif  // DUET_SERVER_COMMON_LISTEN_ADDRESS_H_
