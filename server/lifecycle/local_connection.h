#ifndef DUET_SERVER_LIFECYCLE_LOCAL_CONNECTION_H_
#define DUET_SERVER_LIFECYCLE_LOCAL_CONNECTION_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "server/config/listen_address.h"

namespace duet::server::lifecycle {

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

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_LOCAL_CONNECTION_H_
