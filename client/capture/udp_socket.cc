#include "client/capture/udp_socket.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/capture/stream_reader.h"
#include "model/base/text.h"

namespace duet::client::capture {
namespace {

// About half a second of the largest streams: a longer queue would only hold stale frames.
constexpr int kReceiveBufferBytes = 1 << 20;
constexpr double kMaxWaitMilliseconds = 60'000;

struct AddressList {
  addrinfo* first = nullptr;
  AddressList() = default;
  AddressList(const AddressList&) = delete;
  AddressList& operator=(const AddressList&) = delete;
  ~AddressList() {
    if (first != nullptr) freeaddrinfo(first);
  }
};

std::string Shown(const std::string& host, int port) {
  return absl::StrCat(host.empty() ? "all addresses" : base::Quoted(host), ", UDP port ", port);
}

absl::Status Resolve(const std::string& host, int port, int flags, AddressList* list) {
  addrinfo hints = {};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = flags | AI_NUMERICSERV;
  const int error = getaddrinfo(host.empty() ? nullptr : host.c_str(), std::to_string(port).c_str(),
                                &hints, &list->first);
  if (error == 0) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("address: expected the address of a host, got ",
                                                 Shown(host, port), ": ", gai_strerror(error)));
}

// An IPv6 socket on all addresses receives IPv4 too, so IPv6 comes first there.
std::vector<const addrinfo*> Candidates(const AddressList& list) {
  std::vector<const addrinfo*> candidates;
  for (const addrinfo* a = list.first; a != nullptr; a = a->ai_next) candidates.push_back(a);
  std::stable_partition(candidates.begin(), candidates.end(),
                        [](const addrinfo* a) { return a->ai_family == AF_INET6; });
  return candidates;
}

int PortOf(int socket) {
  sockaddr_storage address = {};
  socklen_t size = sizeof(address);
  if (getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  const in_port_t port = address.ss_family == AF_INET6
                             ? reinterpret_cast<sockaddr_in6*>(&address)->sin6_port
                             : reinterpret_cast<sockaddr_in*>(&address)->sin_port;
  return ntohs(port);
}

}  // namespace

FileDescriptor::FileDescriptor(FileDescriptor&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)) {}

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

FileDescriptor::~FileDescriptor() {
  if (fd_ >= 0) close(fd_);
}

UdpReceiver::UdpReceiver(FileDescriptor socket, FileDescriptor stop, int port)
    : socket_(std::move(socket)), stop_(std::move(stop)), port_(port), buffer_(kMaxDatagramBytes) {}

absl::StatusOr<std::unique_ptr<UdpReceiver>> UdpReceiver::Bind(const std::string& host, int port) {
  AddressList list;
  absl::Status status = Resolve(host, port, AI_PASSIVE, &list);
  if (!status.ok()) return status;
  int error = EADDRNOTAVAIL;
  for (const addrinfo* address : Candidates(list)) {
    FileDescriptor socket(::socket(address->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    if (socket.get() >= 0) {
      const int off = 0;
      if (address->ai_family == AF_INET6 && host.empty()) {
        setsockopt(socket.get(), IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof(off));
      }
      setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &kReceiveBufferBytes,
                 sizeof(kReceiveBufferBytes));
      if (bind(socket.get(), address->ai_addr, address->ai_addrlen) == 0) {
        FileDescriptor stop(eventfd(0, EFD_CLOEXEC));
        if (stop.get() < 0) return absl::ErrnoToStatus(errno, "eventfd");
        const int bound = PortOf(socket.get());
        return std::unique_ptr<UdpReceiver>(
            new UdpReceiver(std::move(socket), std::move(stop), bound));
      }
    }
    error = errno;
    if (error == EADDRINUSE) break;
  }
  return absl::ErrnoToStatus(error, absl::StrCat("cannot receive on ", Shown(host, port)));
}

absl::StatusOr<std::optional<UdpReceiver::Datagram>> UdpReceiver::Receive(double timeout_seconds) {
  const double wait = std::clamp(std::ceil(timeout_seconds * 1e3), 0.0, kMaxWaitMilliseconds);
  pollfd files[] = {{socket_.get(), POLLIN, 0}, {stop_.get(), POLLIN, 0}};
  const int ready = poll(files, 2, static_cast<int>(wait));
  if (ready < 0 && errno != EINTR) return absl::ErrnoToStatus(errno, "poll");
  if (ready <= 0 || files[1].revents != 0) return std::nullopt;
  sockaddr_storage from = {};
  socklen_t size = sizeof(from);
  const ssize_t bytes = recvfrom(socket_.get(), buffer_.data(), buffer_.size(), MSG_DONTWAIT,
                                 reinterpret_cast<sockaddr*>(&from), &size);
  if (bytes < 0) {
    if (errno == EAGAIN || errno == EINTR || errno == ECONNREFUSED) return std::nullopt;
    return absl::ErrnoToStatus(errno, "cannot receive");
  }
  return Datagram{{buffer_.data(), static_cast<std::size_t>(bytes)},
                  std::string(reinterpret_cast<const char*>(&from), size)};
}

void UdpReceiver::Stop() {
  const uint64_t one = 1;
  (void)!write(stop_.get(), &one, sizeof(one));
}

bool UdpReceiver::stopped() const {
  pollfd file = {stop_.get(), POLLIN, 0};
  return poll(&file, 1, 0) > 0;
}

absl::StatusOr<UdpSender> UdpSender::Connect(const std::string& host, int port) {
  AddressList list;
  absl::Status status = Resolve(host, port, 0, &list);
  if (!status.ok()) return status;
  int error = EADDRNOTAVAIL;
  for (const addrinfo* address = list.first; address != nullptr; address = address->ai_next) {
    FileDescriptor socket(::socket(address->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    if (socket.get() >= 0 && connect(socket.get(), address->ai_addr, address->ai_addrlen) == 0) {
      return UdpSender(std::move(socket));
    }
    error = errno;
  }
  return absl::ErrnoToStatus(error, absl::StrCat("cannot send to ", Shown(host, port)));
}

absl::Status UdpSender::Send(absl::string_view datagram) {
  if (send(socket_.get(), datagram.data(), datagram.size(), MSG_DONTWAIT) >= 0) {
    return absl::OkStatus();
  }
  switch (errno) {
    case ECONNREFUSED:
    case EAGAIN:
    case ENOBUFS:
    case ENETUNREACH:
    case EHOSTUNREACH:
    case EINTR:
      return absl::OkStatus();
    default:
      return absl::ErrnoToStatus(errno, "cannot send");
  }
}

}  // namespace duet::client::capture
