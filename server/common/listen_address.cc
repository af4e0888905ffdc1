#include "server/common/listen_address.h"

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <memory>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"

namespace duet::server::common {
namespace {

bool IsAnyHost(const std::string& host) { return host == "0.0.0.0" || host == "::"; }

bool IsLoopback(const std::string& host) { return host == "127.0.0.1" || host == "::1"; }

}  // namespace

absl::StatusOr<ListenAddress> ParseListenAddress(const std::string& text) {
  const absl::Status malformed = absl::InvalidArgumentError(absl::StrCat(
      "expected host:port, such as 0.0.0.0:50051, with a port of 0 to 65535, got \"", text, "\""));
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return malformed;
  ListenAddress address;
  absl::string_view host(text.data(), colon);
  const bool bracketed = absl::ConsumePrefix(&host, "[") && absl::ConsumeSuffix(&host, "]");
  if (!bracketed && absl::StrContains(host, ":")) return malformed;
  address.host = host.empty() ? "0.0.0.0" : std::string(host);
  const absl::string_view port = absl::string_view(text).substr(colon + 1);
  if (!absl::SimpleAtoi(port, &address.port) || address.port < 0 || address.port > 65535) {
    return malformed;
  }
  return address;
}

std::string ToString(const ListenAddress& address) {
  const bool ipv6 = absl::StrContains(address.host, ":");
  return absl::StrCat(ipv6 ? "[" : "", address.host, ipv6 ? "]" : "", ":", address.port);
}

std::optional<ListenAddress> AddressOf(const std::string& setting) {
  absl::StatusOr<ListenAddress> address = ParseListenAddress(setting);
  if (!address.ok()) return std::nullopt;
  return *std::move(address);
}

bool Clash(const ListenAddress& a, const ListenAddress& b) {
  if (a.port != b.port || a.port == 0) return false;
  const bool local = (a.host == "localhost" && IsLoopback(b.host)) ||
                     (b.host == "localhost" && IsLoopback(a.host));
  return a.host == b.host || IsAnyHost(a.host) || IsAnyHost(b.host) || local;
}

namespace {

// Binds a socket to the address and closes it. Returns 0 or the error.
int TryBind(const addrinfo& at) {
  const int socket = ::socket(at.ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return errno;
  // With SO_REUSEADDR only a listening socket conflicts, as for a server that starts, and this
  // socket, which does not listen, blocks no other.
  const int yes = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  const int error = bind(socket, at.ai_addr, at.ai_addrlen) == 0 ? 0 : errno;
  close(socket);
  return error;
}

absl::Status Refusal(const std::string& host, int port, int error) {
  const std::string address = absl::StrCat(host, ":", port);
  if (error == EADDRINUSE) {
    return absl::AlreadyExistsError(
        absl::StrCat("expected a free port, got ", address, ", which is in use"));
  }
  return absl::FailedPreconditionError(absl::StrCat(
      "expected an address of this machine and a port that this user may listen on, got ", address,
      " (", std::strerror(error), ")"));
}

absl::Status CheckOneHost(const std::string& host, int port) {
  addrinfo hints = {};
  hints.ai_flags = AI_PASSIVE;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int unresolved = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  if (unresolved != 0) {
    return absl::NotFoundError(
        absl::StrCat("expected a host name that resolves, or an IP address, got ",
                     base::Quoted(host), " (", gai_strerror(unresolved), ")"));
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, freeaddrinfo);
  int reason = EADDRNOTAVAIL;
  for (const addrinfo* at = found; at != nullptr; at = at->ai_next) {
    const int error = TryBind(*at);
    if (error == 0) return absl::OkStatus();
    // One of a name's addresses may be of a family that this machine lacks.
    if (error != EAFNOSUPPORT) reason = error;
  }
  return Refusal(host, port, reason);
}

}  // namespace

absl::Status CheckBindable(const std::string& host, int port) {
  const absl::Status status = CheckOneHost(host, port);
  // Without IPv6, gRPC's "::" is every IPv4 address.
  const bool no_ipv6 = host == "::" && absl::IsFailedPrecondition(status);
  return no_ipv6 ? CheckOneHost("0.0.0.0", port) : status;
}

absl::Status ListenFailure(const std::string& host, int port) {
  const absl::Status reason = CheckBindable(host, port);
  if (!reason.ok()) return absl::UnavailableError(reason.message());
  return absl::UnavailableError(absl::StrCat("expected a free port, got ", host, ":", port,
                                             ", which was in use a moment ago; try again"));
}

}  // namespace duet::server::common
