#ifndef DUET_SERVER_LIFECYCLE_SERVICE_MANAGER_H_
#define DUET_SERVER_LIFECYCLE_SERVICE_MANAGER_H_

#include <string>

#include "absl/strings/string_view.h"

namespace duet::server::lifecycle {

// Tells systemd, or whoever else started the process and set NOTIFY_SOCKET, how it stands. Without
// that variable nobody is told.
//
// Source: sd_notify(3): a datagram of lines to a Unix socket, abstract where its name begins with
// '@'. Threads: safe to call concurrently.
class ServiceManager {
 public:
  // `socket`: as in NOTIFY_SOCKET; may be empty.
  explicit ServiceManager(std::string socket) : socket_(std::move(socket)) {}
  // That of this process.
  static ServiceManager OfProcess();

  // Calls are served; `status` is a line for people.
  void Ready(absl::string_view status) const;
  // A reload has begun; Ready ends it.
  void Reloading() const;
  void Stopping() const;

 private:
  void Send(const std::string& message) const;

  const std::string socket_;
};

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_SERVICE_MANAGER_H_
