#include "server/lifecycle/check_health.h"

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "server/config/listen_address.h"
#include "server/lifecycle/local_connection.h"
#include "server/lifecycle/self_check.h"

namespace duet::server::lifecycle {
namespace {

constexpr absl::string_view kRequest =
    "GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";

}  // namespace

absl::Status CheckHealth(const v1::ServerConfig& settings, double timeout_seconds) {
  const std::optional<config::ListenAddress> metrics = config::AddressOf(settings.metrics_listen());
  if (!metrics.has_value()) {
    const std::optional<config::ListenAddress> grpc = config::AddressOf(settings.listen());
    if (!grpc.has_value()) return absl::UnavailableError("listen: expected host:port, got none");
    return CheckListener(grpc->host, grpc->port, timeout_seconds);
  }
  absl::StatusOr<LocalConnection> connection = LocalConnection::Open(*metrics, timeout_seconds);
  if (!connection.ok()) return connection.status();
  if (absl::Status status = connection->Send(kRequest); !status.ok()) return status;
  const absl::StatusOr<std::string> answer = connection->ReadAll();
  if (!answer.ok()) return answer.status();
  if (absl::StartsWith(*answer, "HTTP/1.1 200 ")) return absl::OkStatus();
  const std::vector<absl::string_view> lines = absl::StrSplit(*answer, "\r\n");
  return absl::UnavailableError(
      absl::StrCat("/healthz: expected the status 200, got \"", lines[0], "\""));
}

}  // namespace duet::server::lifecycle
