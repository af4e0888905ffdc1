#include "server/metrics/metrics_endpoint.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <deque>
#include <thread>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "server/common/clock.h"
#include "server/common/listen_address.h"

namespace duet::server::metrics {
namespace {

using std::chrono::steady_clock;

constexpr int kBacklog = 128;
// Pause of the listener after accept has failed because no descriptors are left. The kernel keeps
// the connection waiting, and an immediate retry would keep a core busy.
constexpr std::chrono::milliseconds kRest(100);

class Socket {
 public:
  Socket() = default;
  explicit Socket(int number) : number_(number) {}
  Socket(Socket&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Socket() {
    if (number_ >= 0) close(number_);
  }
  int get() const { return number_; }
  explicit operator bool() const { return number_ >= 0; }

 private:
  int number_ = -1;
};

// Without SO_REUSEPORT a second server on the port fails to start instead of taking half of the
// connections.
Socket ListenOn(const std::string& host, int port) {
  addrinfo hints = {};
  hints.ai_flags = AI_PASSIVE;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) return Socket();
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, freeaddrinfo);
  for (const addrinfo* at = found; at != nullptr; at = at->ai_next) {
    Socket socket(::socket(at->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    const int yes = 1;
    if (socket) setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    if (socket && bind(socket.get(), at->ai_addr, at->ai_addrlen) == 0 &&
        listen(socket.get(), kBacklog) == 0) {
      return socket;
    }
  }
  return Socket();
}

int PortOf(const Socket& socket) {
  sockaddr_storage address = {};
  socklen_t size = sizeof(address);
  getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.ss_family == AF_INET6
                   ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                   : reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

// A client's connection: the bytes received and the reply.
class Connection {
 public:
  Connection(Socket socket, steady_clock::time_point end) : socket_(std::move(socket)), end_(end) {}

  pollfd Wanted() const {
    return {socket_.get(), static_cast<short>(reply_ ? POLLOUT : POLLIN), 0};
  }
  steady_clock::time_point end() const { return end_; }

  // Reads or writes without blocking. Returns false when the connection is finished.
  bool Proceed(const HttpPages& pages) {
    if (!reply_ && !Receive(pages)) return false;
    return !reply_ || Send();
  }

 private:
  bool Receive(const HttpPages& pages) {
    char bytes[2048];
    const ssize_t got = recv(socket_.get(), bytes, sizeof(bytes), 0);
    if (got == 0) return false;
    if (got < 0) return errno == EAGAIN || errno == EINTR;
    received_.append(bytes, static_cast<std::size_t>(got));
    reply_ = HttpReply(received_, pages);
    return true;
  }

  bool Send() {
    const ssize_t sent =
        send(socket_.get(), reply_->data() + sent_, reply_->size() - sent_, MSG_NOSIGNAL);
    if (sent < 0) return errno == EAGAIN || errno == EINTR;
    sent_ += static_cast<std::size_t>(sent);
    if (sent_ < reply_->size()) return true;
    // Unread bytes of the client would turn the close into a reset, which may overtake the reply.
    shutdown(socket_.get(), SHUT_WR);
    char bytes[2048];
    while (recv(socket_.get(), bytes, sizeof(bytes), 0) > 0) {
    }
    return false;
  }

  Socket socket_;
  steady_clock::time_point end_;
  std::string received_;
  std::optional<std::string> reply_;
  std::size_t sent_ = 0;
};

class PollingEndpoint final : public MetricsEndpoint {
 public:
  explicit PollingEndpoint(MetricsEndpointOptions options)
      : options_(std::move(options)), pages_(Pages()), stop_(eventfd(0, EFD_CLOEXEC)) {}

  ~PollingEndpoint() override {
    const std::uint64_t one = 1;
    if (thread_.joinable() && write(stop_.get(), &one, sizeof(one)) == sizeof(one)) thread_.join();
  }

  absl::Status Start() {
    listener_ = ListenOn(options_.host, options_.port);
    if (!listener_) return common::ListenFailure(options_.host, options_.port);
    port_ = PortOf(listener_);
    thread_ = std::thread([this] { Run(); });
    return absl::OkStatus();
  }

  int port() const override { return port_; }

 private:
  HttpPages Pages() const {
    const auto state = [](bool good, const char* yes, const char* no) {
      return HttpPage{good, "text/plain", good ? yes : no};
    };
    return {
        {"/metrics",
         [this] {
           return HttpPage{true, "text/plain; version=0.0.4; charset=utf-8", options_.render()};
         }},
        {"/healthz",
         [this, state] { return state(options_.healthy(), "ok\n", "not reachable\n"); }},
        {"/readyz", [this, state] { return state(options_.ready(), "ready\n", "not ready\n"); }}};
  }

  void Run() {
    std::vector<pollfd> wanted;
    while (true) {
      wanted = {{stop_.get(), POLLIN, 0}, {listener_.get(), POLLIN, 0}};
      const auto now = steady_clock::now();
      if (now < rests_until_) wanted[1].events = 0;
      for (const Connection& connection : connections_) wanted.push_back(connection.Wanted());
      if (poll(wanted.data(), wanted.size(), Timeout(now)) < 0 && errno != EINTR) return;
      if (wanted[0].revents != 0) return;
      Serve(wanted);
      if ((wanted[1].revents & POLLIN) != 0) Accept();
    }
  }

  // Milliseconds until the next timeout; -1 if none.
  int Timeout(steady_clock::time_point now) const {
    auto next = steady_clock::time_point::max();
    if (now < rests_until_) next = rests_until_;
    if (!connections_.empty()) next = std::min(next, connections_.front().end());
    if (next == steady_clock::time_point::max()) return -1;
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(next - now).count();
    return static_cast<int>(std::max<std::int64_t>(0, left) + 1);
  }

  // Proceeds with connections that are ready and ends those that have expired. In `wanted`, two
  // other descriptors precede those of the connections.
  void Serve(const std::vector<pollfd>& wanted) {
    const auto now = steady_clock::now();
    std::deque<Connection> open;
    for (std::size_t i = 0; i < connections_.size(); ++i) {
      Connection& connection = connections_[i];
      const bool ready = wanted[i + 2].revents != 0;
      if (now < connection.end() && (!ready || connection.Proceed(pages_))) {
        open.push_back(std::move(connection));
      }
    }
    connections_ = std::move(open);
  }

  // Accepts one connection: poll has announced only one, and without descriptors accept fails even
  // if none is waiting.
  void Accept() {
    Socket socket(accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!socket) {
      if (errno == EAGAIN || errno == EINTR || errno == ECONNABORTED) return;
      // Out of descriptors: close the oldest connection for the next client.
      if (!connections_.empty()) connections_.pop_front();
      rests_until_ = steady_clock::now() + kRest;
      return;
    }
    if (connections_.size() >= options_.max_connections) connections_.pop_front();
    connections_.emplace_back(std::move(socket),
                              steady_clock::now() + common::Seconds(options_.connection_seconds));
  }

  const MetricsEndpointOptions options_;
  const HttpPages pages_;
  const Socket stop_;
  Socket listener_;
  std::deque<Connection> connections_;  // the oldest first
  steady_clock::time_point rests_until_;
  std::thread thread_;
  int port_ = 0;
};

}  // namespace

absl::StatusOr<std::unique_ptr<MetricsEndpoint>> MetricsEndpoint::Start(
    MetricsEndpointOptions options) {
  auto endpoint = std::make_unique<PollingEndpoint>(std::move(options));
  const absl::Status started = endpoint->Start();
  if (!started.ok()) return started;
  return endpoint;
}

namespace {

// `status`: code and reason. `fields`: further lines of the head.
std::string Response(absl::string_view status, absl::string_view content_type,
                     absl::string_view body, bool with_body = true, absl::string_view fields = "") {
  return absl::StrCat("HTTP/1.1 ", status, "\r\nContent-Type: ", content_type,
                      "\r\nContent-Length: ", body.size(), "\r\n", fields,
                      "Connection: close\r\n\r\n", with_body ? body : "");
}

std::string Refusal(absl::string_view status, absl::string_view fields = "") {
  return Response(status, "text/plain", absl::StrCat(status, "\n"), true, fields);
}

}  // namespace

std::optional<std::string> HttpReply(std::string_view received, const HttpPages& pages) {
  const std::size_t end = received.find("\r\n\r\n");
  if (std::min(end, received.size()) > kMaxHttpHeadBytes) {
    return Refusal("431 Request Header Fields Too Large");
  }
  if (end == std::string_view::npos) return std::nullopt;
  const std::vector<absl::string_view> words =
      absl::StrSplit(absl::string_view(received.data(), received.find("\r\n")), ' ');
  if (words.size() != 3 || !absl::StartsWith(words[2], "HTTP/1.")) {
    return Refusal("400 Bad Request");
  }
  const bool head = words[0] == "HEAD";
  if (!head && words[0] != "GET") return Refusal("405 Method Not Allowed", "Allow: GET, HEAD\r\n");
  const auto found = pages.find(words[1].substr(0, words[1].find('?')));
  if (found == pages.end()) return Refusal("404 Not Found");
  const HttpPage page = found->second();
  return Response(page.is_good ? "200 OK" : "503 Service Unavailable", page.content_type, page.body,
                  !head);
}

}  // namespace duet::server::metrics
