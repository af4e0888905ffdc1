#include "server/lifecycle/self_check.h"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "server/config/listen_address.h"

namespace duet::server::lifecycle {
namespace {

// A TCP connection to a server on this machine, for checks of its health. Each step fails with
// UNAVAILABLE and its name. All of them together take at most the time that Open was given.
//
// Threads: not safe to call concurrently. Blocks.
class LocalConnection {
 public:
  // `address` is one that the server listens on; if it means every interface, this machine's
  // loopback address is used.
  static absl::StatusOr<LocalConnection> Open(const config::ListenAddress& address,
                                              double timeout_seconds);
  LocalConnection(LocalConnection&& other) noexcept;
  LocalConnection& operator=(LocalConnection&&) = delete;
  ~LocalConnection();

  // Sends a short text.
  absl::Status Send(absl::string_view text) const;
  // Sends nothing more.
  absl::Status EndOutput() const;
  // Waits for data or the end of the connection.
  absl::Status WaitForAnswer() const;
  // Returns what the server sends until it ends the connection, at most 64 KiB of it.
  absl::StatusOr<std::string> ReadAll() const;

 private:
  LocalConnection(int socket, double end_seconds) : socket_(socket), end_seconds_(end_seconds) {}
  absl::Status Connect(const config::ListenAddress& address);
  // Returns whether the socket is ready in time. Polls at least once.
  bool WaitFor(int events) const;

  int socket_;
  double end_seconds_;  // of the steady clock
};

constexpr std::size_t kMostAnswerBytes = 64 << 10;

double NowSeconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

absl::Status Failure(absl::string_view step, int error) {
  return absl::UnavailableError(absl::StrCat("the server does not answer on its own port: ", step,
                                             error == 0 ? "" : ": ",
                                             error == 0 ? "" : std::strerror(error)));
}

std::string Reachable(const std::string& host) {
  if (host.empty() || host == "0.0.0.0") return "127.0.0.1";
  return host == "::" ? "::1" : host;
}

absl::StatusOr<LocalConnection> LocalConnection::Open(const config::ListenAddress& address,
                                                      double timeout_seconds) {
  LocalConnection connection(-1, NowSeconds() + timeout_seconds);
  if (absl::Status status = connection.Connect(address); !status.ok()) return status;
  return connection;
}

LocalConnection::LocalConnection(LocalConnection&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), end_seconds_(other.end_seconds_) {}

LocalConnection::~LocalConnection() {
  if (socket_ >= 0) close(socket_);
}

absl::Status LocalConnection::Connect(const config::ListenAddress& address) {
  addrinfo hints = {};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int unresolved = getaddrinfo(Reachable(address.host).c_str(),
                                     std::to_string(address.port).c_str(), &hints, &found);
  if (unresolved != 0) {
    return Failure(absl::StrCat("cannot resolve ", address.host, ": ", gai_strerror(unresolved)),
                   0);
  }
  socket_ = socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int opening = socket_ < 0 ? errno : 0;
  const bool connected = socket_ >= 0 && connect(socket_, found->ai_addr, found->ai_addrlen) == 0;
  int error = connected ? 0 : errno;
  freeaddrinfo(found);
  if (opening != 0) return Failure("cannot open a socket", opening);
  if (error == EINPROGRESS) {
    if (!WaitFor(POLLOUT)) return Failure("cannot connect in time", 0);
    socklen_t size = sizeof(error);
    getsockopt(socket_, SOL_SOCKET, SO_ERROR, &error, &size);
  }
  return error == 0 ? absl::OkStatus() : Failure("cannot connect", error);
}

bool LocalConnection::WaitFor(int events) const {
  while (true) {
    const int left = static_cast<int>(std::max(0.0, 1000 * (end_seconds_ - NowSeconds())));
    pollfd wanted = {socket_, static_cast<std::int16_t>(events), 0};
    const int ready = poll(&wanted, 1, left);
    if (ready > 0) return true;
    if (left <= 0 || (ready < 0 && errno != EINTR)) return false;
  }
}

absl::Status LocalConnection::Send(absl::string_view text) const {
  const ssize_t sent = send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
  if (sent < 0) return Failure("cannot send", errno);
  return static_cast<std::size_t>(sent) == text.size() ? absl::OkStatus()
                                                       : Failure("cannot send at once", 0);
}

absl::Status LocalConnection::EndOutput() const {
  return shutdown(socket_, SHUT_WR) == 0 ? absl::OkStatus()
                                         : Failure("cannot shut the connection down", errno);
}

absl::Status LocalConnection::WaitForAnswer() const {
  return WaitFor(POLLIN) ? absl::OkStatus() : Failure("connected, but got no answer", 0);
}

absl::StatusOr<std::string> LocalConnection::ReadAll() const {
  std::string answer;
  while (answer.size() < kMostAnswerBytes) {
    if (absl::Status status = WaitForAnswer(); !status.ok()) return status;
    char buffer[4096];
    const ssize_t read = recv(socket_, buffer, sizeof(buffer), 0);
    if (read < 0 && errno != EAGAIN && errno != EINTR) return Failure("cannot read", errno);
    if (read == 0) break;
    if (read > 0) answer.append(buffer, static_cast<std::size_t>(read));
  }
  return answer;
}

constexpr common::StepKind kChecking{"self-check", "calling the server itself"};

constexpr absl::string_view kRequest =
    "GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";

}  // namespace

absl::Status CheckListener(const std::string& host, int port, double timeout_seconds) {
  absl::StatusOr<LocalConnection> connection = LocalConnection::Open({host, port}, timeout_seconds);
  if (!connection.ok()) return connection.status();
  // Send nothing: plain text would be an error in the log of a server with TLS, and a TLS handshake
  // needs certificates.
  if (absl::Status status = connection->EndOutput(); !status.ok()) return status;
  // Data, or the end of the connection, shows that the server accepted it.
  return connection->WaitForAnswer();
}

SelfCheck::SelfCheck(SelfCheckOptions options)
    : options_(std::move(options)),
      task_(std::make_unique<RepeatedTask>(kChecking, options_.interval_seconds,
                                           [this] { Check(); })) {}

void SelfCheck::Check() {
  const absl::Status status = options_.check();
  const bool passed = passes();
  if (status.ok()) {
    failures_ = 0;
  } else {
    ++failures_;
    options_.failed(status);
  }
  if (passed != passes()) options_.changed(passes());
}

absl::Status CheckHealth(const v1::ServerConfig& settings, double timeout_seconds) {
  const std::optional<config::ListenAddress> metrics = config::AddressOf(settings.metrics_listen());
  if (!metrics.has_value()) {
    const std::optional<config::ListenAddress> grpc = config::AddressOf(settings.listen());
    if (!grpc.has_value()) return absl::UnavailableError("listen: expected host:port, got none");
    return CheckListener(grpc->host, grpc->port, timeout_seconds);
  }
  absl::StatusOr<LocalConnection> connection = LocalConnection::Open(*metrics, timeout_seconds);
  if (!connection.ok()) return connection.status();
  if (absl::Status status = connection->Send(kRequest); !status.ok()) return status;
  const absl::StatusOr<std::string> answer = connection->ReadAll();
  if (!answer.ok()) return answer.status();
  if (absl::StartsWith(*answer, "HTTP/1.1 200 ")) return absl::OkStatus();
  const std::vector<absl::string_view> lines = absl::StrSplit(*answer, "\r\n");
  return absl::UnavailableError(
      absl::StrCat("/healthz: expected the status 200, got \"", lines[0], "\""));
}

}  // namespace duet::server::lifecycle
