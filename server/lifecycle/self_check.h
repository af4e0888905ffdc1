#ifndef DUET_SERVER_LIFECYCLE_SELF_CHECK_H_
#define DUET_SERVER_LIFECYCLE_SELF_CHECK_H_

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "server/lifecycle/repeated_task.h"

namespace duet::server::lifecycle {

// Whether a server of HTTP/2 still takes connections: connects, greets, and waits for any word, or
// for the connection to be closed, as a server that wants TLS does.
//
// A listening socket is not enough. gRPC 1.51 stops accepting for good once it has run out of
// descriptors (CVE-2023-4785); the kernel goes on connecting clients that nobody serves.
//
// `host`: an address to listen on; one for every interface stands for this machine.
// Fails with UNAVAILABLE, saying which step failed.
absl::Status CheckListener(const std::string& host, int port, double timeout_seconds);

struct SelfCheckOptions {
  std::string host;
  int port = 0;
  double interval_seconds = 10;
  double timeout_seconds = 5;
  std::function<void(const absl::Status&)> failed;  // told of each failure
};

// Checks again and again, on a thread of its own.
class SelfCheck {
 public:
  explicit SelfCheck(SelfCheckOptions options);

  // False once three checks in a row have failed, until one succeeds.
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
