#ifndef DUET_SERVER_LIFECYCLE_SELF_CHECK_H_
#define DUET_SERVER_LIFECYCLE_SELF_CHECK_H_

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "server/common/activity.h"
#include "server/lifecycle/repeated_task.h"

namespace duet::server::lifecycle {

// Whether a server still takes connections: connects, takes leave at once, and waits for any word,
// or for the connection to be closed.
//
// A listening socket is not enough. gRPC 1.51 stops accepting for good once it has run out of
// descriptors (CVE-2023-4785); the kernel goes on connecting clients that nobody serves.
//
// `host`: an address to listen on; one for every interface stands for this machine.
// Fails with UNAVAILABLE, saying which step failed.
absl::Status CheckListener(const std::string& host, int port, double timeout_seconds);

struct SelfCheckOptions {
  double interval_seconds = 10;
  std::function<absl::Status()> check;              // such as CheckListener
  std::function<void(const absl::Status&)> failed;  // called for each failure
  // Called when a check fails after one that did not, and when one succeeds again.
  std::function<void(bool passes)> changed;
};

// Checks again and again, on a thread of its own.
class SelfCheck {
 public:
  explicit SelfCheck(SelfCheckOptions options);

  // False once a check has failed, until one succeeds: no new calls should come.
  bool passes() const { return failures_ == 0; }
  // False once three checks in a row have failed, until one succeeds: a restart would help.
  bool healthy() const { return failures_ < kFailures; }

 private:
  static constexpr int kFailures = 3;

  void Check();

  const SelfCheckOptions options_;
  std::atomic<int> failures_{0};
  RepeatedTask task_;
};

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_SELF_CHECK_H_
