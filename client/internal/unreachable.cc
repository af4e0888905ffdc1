#include "client/internal/unreachable.h"

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"

namespace duet::client::internal {
namespace {

struct Cause {
  absl::string_view sign;  // part of gRPC's message
  absl::string_view text;  // what follows the address
};

// The first one whose sign is in the message applies: gRPC's message of a failed handshake contains
// its cause.
constexpr Cause kCauses[] = {
    {"unhealthy", "is not ready: it loads its models, or it shuts down"},
    {"Connection refused", "is not running: it refused the connection"},
    {"No such file or directory", "is not running: its socket does not exist"},
    {"DNS resolution failed", "cannot be found: the name has no address"},
    {"http1.x", "is not a Duet server: it does not speak gRPC"},
    {"HTTP/2", "is not a Duet server: it does not speak gRPC"},
    {"wrong version number", "does not encrypt, but this client does"},
    {"certificate verify failed", "is not trusted: its certificate was not accepted"},
    {"CERTIFICATE_VERIFY_FAILED", "is not trusted: its certificate was not accepted"},
    {"Ssl handshake failed", "cannot be reached: the TLS handshake failed"},
    {"timed out", "does not answer: the connection timed out"},
    {"No route to host", "cannot be reached: there is no route to it"},
    {"Network is unreachable", "cannot be reached: there is no route to it"},
    // A server that encrypts does so to a client that does not.
    {"Connection reset", "closed the connection: it has stopped, or it expects TLS"},
    {"Socket closed", "closed the connection: it has stopped, or it expects TLS"},
};

}  // namespace

std::string DescribeUnreachable(absl::string_view address, absl::string_view message) {
  const std::string server = absl::StrCat("the server at ", address, " ");
  for (const Cause& cause : kCauses) {
    if (absl::StrContains(message, cause.sign)) return absl::StrCat(server, cause.text);
  }
  return absl::StrCat(server, "cannot be reached: ", message);
}

}  // namespace duet::client::internal
