#include "server/lifecycle/local_connection.h"

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
#include <utility>

#include "absl/strings/str_cat.h"

namespace duet::server::lifecycle {
namespace {

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

}  // namespace

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

}  // namespace duet::server::lifecycle
