#ifndef DUET_CLIENT_CAPTURE_UDP_SOCKET_H_
#define DUET_CLIENT_CAPTURE_UDP_SOCKET_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::client::capture {

// A file descriptor that is closed with its owner.
class FileDescriptor {
 public:
  explicit FileDescriptor(int fd = -1) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept;
  FileDescriptor& operator=(FileDescriptor&& other) noexcept;
  ~FileDescriptor();
  int get() const { return fd_; }

 private:
  int fd_;
};

// Receives datagrams on a port.
//
// Threads: one thread receives; any thread may stop it.
class UdpReceiver {
 public:
  struct Datagram {
    absl::string_view bytes;  // valid until the next call
    std::string sender;       // its address, as bytes
  };

  // host: an address of this machine, IPv4 or IPv6, or a name; empty: all of them. port: 0: any
  // free one. Errors: those of the system, naming the address.
  static absl::StatusOr<std::unique_ptr<UdpReceiver>> Bind(const std::string& host, int port);

  int port() const { return port_; }

  // Waits for a datagram, at most `timeout_seconds` (infinite: without limit). Absent: none came,
  // or Stop was called.
  absl::StatusOr<std::optional<Datagram>> Receive(double timeout_seconds);

  // Makes Receive return at once, now and later.
  void Stop();
  bool stopped() const;

 private:
  UdpReceiver(FileDescriptor socket, FileDescriptor stop, int port);

  FileDescriptor socket_, stop_;
  int port_;
  std::vector<char> buffer_;
};

// Sends datagrams to one address.
class UdpSender {
 public:
  // Errors: INVALID_ARGUMENT for a host that cannot be resolved; those of the system.
  static absl::StatusOr<UdpSender> Connect(const std::string& host, int port);

  // A datagram that cannot be delivered is lost, as UDP has it: nobody listens, the network is
  // full. Errors: others of the system.
  absl::Status Send(absl::string_view datagram);

 private:
  explicit UdpSender(FileDescriptor socket) : socket_(std::move(socket)) {}

  FileDescriptor socket_;
};

}  // namespace duet::client::capture

#endif  // DUET_CLIENT_CAPTURE_UDP_SOCKET_H_
