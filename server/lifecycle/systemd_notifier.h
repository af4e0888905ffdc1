#ifndef DUET_SERVER_LIFECYCLE_SYSTEMD_NOTIFIER_H_
#define DUET_SERVER_LIFECYCLE_SYSTEMD_NOTIFIER_H_

#include <string>

#include "absl/strings/string_view.h"

namespace duet::server::lifecycle {

// Reports the state of the process to systemd, or to another service manager that has set
// NOTIFY_SOCKET. Does nothing without that variable.
//
// Source:  sd_notify(3): a datagram of lines to a Unix socket, which is abstract if its name begins
//          with '@'.
// Threads: safe to call concurrently.
class SystemdNotifier {
 public:
  // `socket`: the value of NOTIFY_SOCKET; may be empty.
  explicit SystemdNotifier(std::string socket) : socket_(std::move(socket)) {}
  // Uses NOTIFY_SOCKET of this process.
  static SystemdNotifier OfProcess();

  // Calls are served. `status` is a line for people.
  void Ready(absl::string_view status) const;
  // A reload has begun. Ready ends it.
  void Reloading() const;
  void Stopping() const;

 private:
  void Send(const std::string& message) const;

  const std::string socket_;
};

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_SYSTEMD_NOTIFIER_H_
