#include "server/lifecycle/self_check.h"

#include <memory>
#include <string>
#include <utility>

#include "server/lifecycle/local_connection.h"

namespace duet::server::lifecycle {
namespace {

constexpr common::StepKind kChecking{"self-check", "calling the server itself"};

}  // namespace

absl::Status CheckListener(const std::string& host, int port, double timeout_seconds) {
  absl::StatusOr<LocalConnection> connection = LocalConnection::Open({host, port}, timeout_seconds);
  if (!connection.ok()) return connection.status();
  // Send nothing: plain text would be an error in the log of a server with TLS, and a TLS handshake
  // needs certificates.
  if (absl::Status status = connection->EndOutput(); !status.ok()) return status;
  // Data, or the end of the connection, shows that the server accepted it.
  return connection->WaitForAnswer();
}

SelfCheck::SelfCheck(SelfCheckOptions options)
    : options_(std::move(options)),
      task_(std::make_unique<RepeatedTask>(kChecking, options_.interval_seconds,
                                           [this] { Check(); })) {}

void SelfCheck::Check() {
  const absl::Status status = options_.check();
  const bool passed = passes();
  if (status.ok()) {
    failures_ = 0;
  } else {
    ++failures_;
    options_.failed(status);
  }
  if (passed != passes()) options_.changed(passes());
}

}  // namespace duet::server::lifecycle
