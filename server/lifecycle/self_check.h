#ifndef DUET_SERVER_LIFECYCLE_SELF_CHECK_H_
#define DUET_SERVER_LIFECYCLE_SELF_CHECK_H_

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "duet/v1/server_config.pb.h"
#include "server/lifecycle/repeated_task.h"

namespace duet::server::lifecycle {

// Checks whether a server still accepts connections: connects, closes its side at once, and waits
// for data or for the end of the connection.
//
// A listening socket is not enough. gRPC 1.51 stops accepting permanently after it has run out of
// descriptors (CVE-2023-4785), while the kernel continues to complete connections.
//
// `host` is an address that the server listens on; if it means every interface, this machine's
// loopback address is used. Fails with UNAVAILABLE and the step that failed.
absl::Status CheckListener(const std::string& host, int port, double timeout_seconds);

struct SelfCheckOptions {
  double interval_seconds = 10;
  std::function<absl::Status()> check;              // such as CheckListener
  std::function<void()> passed = [] {};             // called at each success
  std::function<void(const absl::Status&)> failed;  // called at each failure
  // Called when the result of a check differs from the previous one.
  std::function<void(bool passes)> changed;
};

// Runs a check periodically on a thread of its own.
class SelfCheck {
 public:
  explicit SelfCheck(SelfCheckOptions options);

  // Ends the checks, and waits for one that is running. The last result stays. Call it on the
  // thread that destroys the object.
  void Stop() { task_ = nullptr; }

  // False after a failed check, until one succeeds: no new calls should arrive.
  bool passes() const { return failures_ == 0; }
  // False after three failed checks in a row, until one succeeds: a restart would help.
  bool healthy() const { return failures_ < kFailures; }

 private:
  static constexpr int kFailures = 3;

  void Check();

  const SelfCheckOptions options_;
  std::atomic<int> failures_{0};
  std::unique_ptr<RepeatedTask> task_;  // null after Stop
};

// Asks the server that runs on this machine with these settings for /healthz, which needs neither
// certificates nor tokens. Without a metrics port, checks whether its gRPC port accepts
// connections. Fails with UNAVAILABLE and the reason if the server is not healthy.
absl::Status CheckHealth(const v1::ServerConfig& settings, double timeout_seconds);

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_SELF_CHECK_H_
