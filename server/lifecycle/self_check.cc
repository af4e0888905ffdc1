#include "server/lifecycle/self_check.h"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "absl/strings/str_cat.h"

namespace duet::server::lifecycle {
namespace {

using std::chrono::steady_clock;

constexpr common::StepKind kChecking{"self-check", "calling the server itself"};

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return number_; }

 private:
  const int number_;
};

absl::Status Failure(std::string_view step, int error) {
  return absl::UnavailableError(
      absl::StrCat("the server does not answer on its own port: ", std::string(step),
                   error == 0 ? "" : ": ", error == 0 ? "" : std::strerror(error)));
}

std::string Reachable(const std::string& host) {
  if (host.empty() || host == "0.0.0.0") return "127.0.0.1";
  return host == "::" ? "::1" : host;
}

// Returns whether the socket is ready before `end`. Polls at least once.
bool WaitFor(int socket, short events, steady_clock::time_point end) {
  while (true) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - steady_clock::now()).count();
    pollfd wanted = {socket, events, 0};
    const int ready = poll(&wanted, 1, static_cast<int>(left > 0 ? left : 0));
    if (ready > 0) return true;
    if (left <= 0 || (ready < 0 && errno != EINTR)) return false;
  }
}

absl::Status Visit(const addrinfo& address, steady_clock::time_point end) {
  const Descriptor socket(
      ::socket(address.ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (socket.get() < 0) return Failure("cannot open a socket", errno);
  if (connect(socket.get(), address.ai_addr, address.ai_addrlen) != 0) {
    if (errno != EINPROGRESS) return Failure("cannot connect", errno);
    if (!WaitFor(socket.get(), POLLOUT, end)) return Failure("cannot connect in time", 0);
  }
  int error = 0;
  socklen_t size = sizeof(error);
  getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &error, &size);
  if (error != 0) return Failure("cannot connect", error);
  // Send nothing: plain text would be an error in the log of a server with TLS, and a TLS handshake
  // needs certificates.
  if (shutdown(socket.get(), SHUT_WR) != 0)
    return Failure("cannot shut the connection down", errno);
  // Data, or the end of the connection, shows that the server accepted it.
  if (!WaitFor(socket.get(), POLLIN, end)) return Failure("connected, but got no answer", 0);
  return absl::OkStatus();
}

}  // namespace

absl::Status CheckListener(const std::string& host, int port, double timeout_seconds) {
  const auto end = steady_clock::now() + std::chrono::duration_cast<steady_clock::duration>(
                                             std::chrono::duration<double>(timeout_seconds));
  addrinfo hints = {};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error =
      getaddrinfo(Reachable(host).c_str(), std::to_string(port).c_str(), &hints, &found);
  if (error != 0)
    return Failure(absl::StrCat("cannot resolve ", host, ": ", gai_strerror(error)), 0);
  const absl::Status status = Visit(*found, end);
  freeaddrinfo(found);
  return status;
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

}  // namespace duet::server::lifecycle
