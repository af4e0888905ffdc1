#ifndef DUET_SERVER_SECURITY_CALLER_H_
#define DUET_SERVER_SECURITY_CALLER_H_

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace duet::server::security {

// What a caller may do. Neither role includes the other: a token that was made to change models
// cannot spend the server's time, and the other way round.
enum class Role {
  kSynthesise,  // duet.v1.MotionSynthesis
  kAdmin,       // the admin service
};

// "synthesise" or "admin".
inline const char* RoleName(Role role) { return role == Role::kAdmin ? "admin" : "synthesise"; }

// What a caller may use at most; absent means no limit of its own.
struct CallerLimits {
  std::optional<double> calls_per_second;        // more than 0; up to a second's worth at once
  std::optional<std::int64_t> frames_in_flight;  // leader frames of calls being answered, 1 or more
};

// Somebody who may call: by what they are known, what they may do, and how much of it.
struct Caller {
  std::string name;  // for logs and metrics
  std::set<Role> roles;
  std::vector<std::string> token_digests;      // SHA-256 in lower-case hex, 64 characters each
  std::vector<std::string> certificate_names;  // as the client's certificate has them
  CallerLimits limits;
};

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_CALLER_H_
