#ifndef DUET_SERVER_CONFIG_LISTEN_ADDRESS_H_
#define DUET_SERVER_CONFIG_LISTEN_ADDRESS_H_

#include <optional>
#include <string>

#include "absl/status/statusor.h"

namespace duet::server::config {

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

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_LISTEN_ADDRESS_H_
