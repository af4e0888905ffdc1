#include "server/lifecycle/systemd_notifier.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdlib>

#include "absl/strings/str_cat.h"

namespace duet::server::lifecycle {

SystemdNotifier SystemdNotifier::OfProcess() {
  const char* socket = std::getenv("NOTIFY_SOCKET");
  return SystemdNotifier(socket == nullptr ? "" : socket);
}

void SystemdNotifier::Ready(absl::string_view status) const {
  Send(absl::StrCat("READY=1\nSTATUS=", status));
}

void SystemdNotifier::Reloading() const {
  // The time, of CLOCK_MONOTONIC, lets systemd match a READY=1 with one of several reloads.
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  Send(absl::StrCat("RELOADING=1\nMONOTONIC_USEC=",
                    std::chrono::duration_cast<std::chrono::microseconds>(now).count()));
}

void SystemdNotifier::Stopping() const { Send("STOPPING=1"); }

void SystemdNotifier::Send(const std::string& message) const {
  sockaddr_un address = {};
  if (socket_.empty() || socket_.size() >= sizeof(address.sun_path)) return;
  address.sun_family = AF_UNIX;
  std::copy(socket_.begin(), socket_.end(), address.sun_path);
  if (socket_[0] == '@') address.sun_path[0] = '\0';
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket_.size());
  const int descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return;
  sendto(descriptor, message.data(), message.size(), MSG_NOSIGNAL,
         reinterpret_cast<const sockaddr*>(&address), length);
  close(descriptor);
}

}  // namespace duet::server::lifecycle
