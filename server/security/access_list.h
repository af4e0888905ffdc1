#ifndef DUET_SERVER_SECURITY_ACCESS_LIST_H_
#define DUET_SERVER_SECURITY_ACCESS_LIST_H_

#include <cstddef>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/security/access_control.h"

namespace duet::server::security {

// Every call searches the whole list.
inline constexpr std::size_t kMaxCallers = 1000;

// What other settings of the server imply for an access file.
struct AccessListRules {
  // Whether clients have certificates (tls_client_ca_file). Without them, cert: identifies no
  // caller.
  bool certificates = true;
};

// Maximum number of mistakes that are reported for a file.
inline constexpr std::size_t kMaxAccessMistakes = 20;

// Parses an access file: one caller per line, words separated by blanks, comments after `#`.
//
//   # name    roles             known by                        limits
//   studio-a  synthesise        sha256:9f86d081...0f00a08       calls_per_second=20
//   studio-b  synthesise        cert:b.example.com              frames_in_flight=20000
//   ops       synthesise,admin  sha256:60303ae2...7ba3b0dd2e2   sha256:fd61a03a...af6b2fc0c
//
// A name is 1 to 64 letters, digits, '-', '_' and '.'. Tokens (their SHA-256, never the token) and
// names in its certificate identify a caller; all of them share its limits.
//
// A file without callers is a mistake, because it would reject every call.
//
// Errors: INVALID_ARGUMENT, one line "source:line: expected ..., got ..." for each of the first
//         kMaxAccessMistakes wrong lines; never a whole digest.
absl::StatusOr<std::vector<Caller>> ParseAccessList(std::string_view text, std::string_view source,
                                                    const AccessListRules& rules = {});

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_ACCESS_LIST_H_
