#include "server/lifecycle/self_check.h"

#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "absl/cleanup/cleanup.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "server/common/listen_address.h"

namespace duet::server::lifecycle {
namespace {

constexpr absl::string_view kRequest =
    "GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";

absl::Status Failure(absl::string_view step, absl::string_view error) {
  return absl::UnavailableError(
      absl::StrCat("the server does not answer on its own port: ", step, ": ", error));
}

std::string Reachable(const std::string& host) {
  if (host.empty() || host == "0.0.0.0") return "127.0.0.1";
  return host == "::" ? "::1" : host;
}

// Sends `text`, which may be empty, to a server on this machine, ends the output, and returns the
// first line that the server sends: empty if it only ends the connection. If `address` means every
// interface, this machine's loopback address is used. Blocks, each step for at most
// `timeout_seconds`. Fails with UNAVAILABLE and the step.
absl::StatusOr<std::string> Ask(const common::ListenAddress& address, absl::string_view text,
                                double timeout_seconds) {
  addrinfo hints = {};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int unresolved = getaddrinfo(Reachable(address.host).c_str(),
                                     std::to_string(address.port).c_str(), &hints, &found);
  if (unresolved != 0) {
    return Failure(absl::StrCat("cannot resolve ", address.host), gai_strerror(unresolved));
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, freeaddrinfo);
  const int descriptor = socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return Failure("cannot open a socket", std::strerror(errno));
  const auto closing = absl::MakeCleanup([descriptor] { close(descriptor); });
  timeval timeout = {};
  timeout.tv_sec = static_cast<time_t>(timeout_seconds);
  timeout.tv_usec =
      static_cast<suseconds_t>((timeout_seconds - static_cast<double>(timeout.tv_sec)) * 1e6);
  setsockopt(descriptor, SOL_SOCKET, SO_SNDTIMEO, &timeout, sizeof(timeout));  // also of connect
  setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof(timeout));
  if (connect(descriptor, found->ai_addr, found->ai_addrlen) != 0) {
    return Failure("cannot connect", std::strerror(errno));
  }
  if (send(descriptor, text.data(), text.size(), MSG_NOSIGNAL) < 0 ||
      shutdown(descriptor, SHUT_WR) != 0) {
    return Failure("cannot send", std::strerror(errno));
  }
  char answer[256];
  const ssize_t size = recv(descriptor, answer, sizeof(answer), 0);
  if (size < 0) return Failure("connected, but got no answer", std::strerror(errno));
  const absl::string_view received(answer, static_cast<std::size_t>(size));
  return std::string(received.substr(0, received.find("\r\n")));
}

}  // namespace

absl::Status CheckListener(const std::string& host, int port, double timeout_seconds) {
  // Sends nothing: plain text would be an error in the log of a server with TLS, and a TLS
  // handshake needs certificates. Data, or the end of the connection, shows that the server
  // accepted it.
  return Ask({host, port}, "", timeout_seconds).status();
}

SelfCheck::SelfCheck(SelfCheckOptions options)
    : options_(std::move(options)),
      task_(std::make_unique<RepeatedTask>(options_.interval_seconds, [this] { Check(); })) {}

void SelfCheck::Check() {
  const absl::Status status = options_.check();
  const bool passed = passes();
  if (status.ok()) {
    failures_ = 0;
    options_.passed();
  } else {
    ++failures_;
    options_.failed(status);
  }
  if (passed != passes()) options_.changed(passes());
}

absl::Status CheckHealth(const v1::ServerConfig& settings, double timeout_seconds) {
  const std::optional<common::ListenAddress> metrics = common::AddressOf(settings.metrics_listen());
  if (!metrics.has_value()) {
    const std::optional<common::ListenAddress> grpc = common::AddressOf(settings.listen());
    if (!grpc.has_value()) return absl::UnavailableError("listen: expected host:port, got none");
    return CheckListener(grpc->host, grpc->port, timeout_seconds);
  }
  const absl::StatusOr<std::string> answer = Ask(*metrics, kRequest, timeout_seconds);
  if (!answer.ok()) return answer.status();
  if (absl::StartsWith(*answer, "HTTP/1.1 200 ")) return absl::OkStatus();
  return absl::UnavailableError(
      absl::StrCat("/healthz: expected the status 200, got \"", *answer, "\""));
}

}  // namespace duet::server::lifecycle
