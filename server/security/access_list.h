#ifndef DUET_SERVER_SECURITY_ACCESS_LIST_H_
#define DUET_SERVER_SECURITY_ACCESS_LIST_H_

#include <cstddef>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/security/caller.h"

namespace duet::server::security {

// A list is looked through for every call.
inline constexpr std::size_t kMaxCallers = 1000;

// What the server's other settings mean for an access file.
struct AccessListRules {
  // Whether clients show certificates (tls_client_ca_file). Without them, nobody is known by cert:.
  bool certificates = true;
};

// How many mistakes of one file are reported.
inline constexpr std::size_t kMaxAccessMistakes = 20;

// Parses an access file: a caller a line, words apart by blanks, `#` before a comment.
//
//   # name    roles             known by                        limits
//   studio-a  synthesise        sha256:9f86d081...0f00a08       calls_per_second=20
//   studio-b  synthesise        cert:b.example.com              frames_in_flight=20000
//   ops       synthesise,admin  sha256:60303ae2...7ba3b0dd2e2   sha256:fd61a03a...af6b2fc0c
//
// A name is 1 to 64 letters, digits, '-', '_' and '.'. A caller is known by one token or several
// (their SHA-256, never the token) and by names in its certificate; all share its limits.
//
// A file that lists nobody is a mistake: it would turn every call away.
//
// Errors: INVALID_ARGUMENT, one line "source:line: expected ..., got ..." for each line that is
//         wrong, the first kMaxAccessMistakes of them; never a whole digest.
absl::StatusOr<std::vector<Caller>> ParseAccessList(std::string_view text, std::string_view source,
                                                    const AccessListRules& rules = {});

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_ACCESS_LIST_H_
