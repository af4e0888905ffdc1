#ifndef DUET_SERVER_COMMON_HTTP_ORIGIN_H_
#define DUET_SERVER_COMMON_HTTP_ORIGIN_H_

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::server::common {

// "http://host:port" or "https://host:port".
struct HttpOrigin {
  bool encrypted = false;
  std::string authority;  // "host:port"
};

// Fails with INVALID_ARGUMENT "expected ..., got ..." for any other text: another scheme, no port,
// user information, a path.
absl::StatusOr<HttpOrigin> ParseHttpOrigin(absl::string_view text);

}  // namespace duet::server::common

#endif  // DUET_SERVER_COMMON_HTTP_ORIGIN_H_
