#ifndef DUET_SERVER_SECURITY_CALLER_H_
#define DUET_SERVER_SECURITY_CALLER_H_

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace duet::server::security {

// What a caller may do. Neither role includes the other: a token for changing models cannot
// synthesise, and the other way round.
enum class Role {
  kSynthesise,  // duet.v1.MotionSynthesis
  kAdmin,       // the admin service
};

// "synthesise" or "admin".
inline const char* RoleName(Role role) { return role == Role::kAdmin ? "admin" : "synthesise"; }

// Limits of a caller; an absent one means no limit of its own.
struct CallerLimits {
  std::optional<double> calls_per_second;  // above 0; bursts of up to one second's calls
  // Leader frames of calls being answered, each counted once for each candidate; at least 1.
  std::optional<std::int64_t> frames_in_flight;
};

// A caller: its credentials, its roles and its limits.
struct Caller {
  std::string name;  // for logs and metrics
  std::set<Role> roles;
  std::vector<std::string> token_digests;      // SHA-256 in lower-case hex, 64 characters each
  std::vector<std::string> certificate_names;  // as the client's certificate has them
  CallerLimits limits;
};

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_CALLER_H_
