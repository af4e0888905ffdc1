#include "server/common/bindable.h"

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "model/base/text.h"

namespace duet::server::common {
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

// One of a name's addresses may be of a family that this machine lacks; the errors of the others
// are more useful then.
bool IsOfAnotherMachine(int error) { return error == EADDRNOTAVAIL || error == EAFNOSUPPORT; }

std::string AddressText(const std::string& host, int port) {
  return absl::StrContains(host, ":") ? absl::StrCat("[", host, "]:", port)
                                      : absl::StrCat(host, ":", port);
}

absl::Status Refusal(const std::string& host, int port, int error) {
  const std::string address = AddressText(host, port);
  if (error == EADDRINUSE) {
    return absl::AlreadyExistsError(absl::StrCat("expected a free port, got ", address,
                                                 ", which is in use; \"ss -tanp sport = :", port,
                                                 "\" shows the socket that holds it"));
  }
  if (error == EACCES || error == EPERM) {
    return absl::PermissionDeniedError(
        absl::StrCat("expected a port that this user may listen on, got ", address, " (",
                     std::strerror(error), "); ports below 1024 need CAP_NET_BIND_SERVICE"));
  }
  if (IsOfAnotherMachine(error)) {
    return absl::FailedPreconditionError(
        absl::StrCat("expected an address of this machine, got ", address, " (",
                     std::strerror(error), "); 0.0.0.0 is every IPv4 address of this machine"));
  }
  return absl::FailedPreconditionError(absl::StrCat("expected an address to listen on, got ",
                                                    address, " (", std::strerror(error), ")"));
}

absl::Status CheckOneHost(const std::string& host, int port) {
  addrinfo hints = {};
  hints.ai_flags = AI_PASSIVE;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int unresolved = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  if (unresolved != 0) {
    return absl::NotFoundError(absl::StrCat(
        "expected a host name that resolves, or an IP address, got ", base::Quoted(host), " (",
        gai_strerror(unresolved), "); 0.0.0.0 is every IPv4 address of this machine"));
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, freeaddrinfo);
  int reason = EADDRNOTAVAIL;
  for (const addrinfo* at = found; at != nullptr; at = at->ai_next) {
    const int error = TryBind(*at);
    if (error == 0) return absl::OkStatus();
    if (!IsOfAnotherMachine(error)) reason = error;
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
  return absl::UnavailableError(absl::StrCat("expected a free port, got ", AddressText(host, port),
                                             ", which was in use a moment ago; try again"));
}

}  // namespace duet::server::common
