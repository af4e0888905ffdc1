#ifndef DUET_SERVER_SECURITY_ACCESS_CONTROL_H_
#define DUET_SERVER_SECURITY_ACCESS_CONTROL_H_

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "server/common/clock.h"
#include "server/common/mutex.h"

namespace duet::server::security {

// What a caller may do. Neither role includes the other: a token for changing models cannot
// synthesise, and the other way round.
enum class Role {
  kSynthesise,  // duet.v1.MotionSynthesis
  kAdmin,       // the admin service
};

// "synthesise" or "admin".
inline const char* RoleName(Role role) { return role == Role::kAdmin ? "admin" : "synthesise"; }

// A caller: its credentials, its roles and its limit.
struct Caller {
  std::string name;  // for logs and metrics
  std::set<Role> roles;
  std::vector<std::string> token_digests;      // SHA-256 in lower-case hex, 64 characters each
  std::vector<std::string> certificate_names;  // as the client's certificate has them
  // Above 0; bursts of up to one second's calls. Absent: no limit.
  std::optional<double> calls_per_second;
};

// The current usage of one caller.
//
// Threads: safe to call concurrently. Uses neither gRPC nor abseil's synchronisation.
class CallerUsage {
 public:
  // Counts a call and returns nullopt, or returns the seconds to wait if the rate is exceeded. The
  // long-term rate is `per_second`; after a pause, the calls of one second may arrive at once.
  std::optional<double> TakeCall(double per_second, common::TimePoint now);

 private:
  common::Mutex mutex_;
  double tokens_ DUET_GUARDED_BY(mutex_) = 0;  // calls allowed now
  std::optional<common::TimePoint> counted_
      DUET_GUARDED_BY(mutex_);  // when tokens_ was last updated
};

// The credentials that a call carries.
struct Credentials {
  bool has_token = false;    // whether there is any authorization
  std::string token_digest;  // SHA-256 of its token; empty for an authorization of another kind
  std::vector<std::string> certificate_names;  // of a certificate that TLS has verified
};

// Whether a call is allowed, and who makes it.
struct CallPass {
  absl::Status status;  // OK, or the reason why the call is rejected
  // The caller's name in the access file, otherwise the first name in its certificate; empty for an
  // unknown caller. A rejected caller can have a name, too.
  std::string name;
  bool is_listed = false;  // in the access file
};

// PERMISSION_DENIED: the caller lacks the role.
absl::Status RoleRefusal(Role role);

// Decides who may do what. The list of callers is replaced as a whole while calls continue.
//
// Threads: safe to call concurrently. Uses neither gRPC nor abseil's synchronisation.
class AccessControl {
 public:
  // `clock` outlives the control.
  explicit AccessControl(const common::Clock& clock) : clock_(clock) {}

  // Replaces all callers. Callers that stay keep their usage.
  void Replace(std::vector<Caller> callers);

  // Identifies the caller, and counts the call if it is allowed. If there is a token, only the
  // token counts: a wrong one is rejected whatever the certificate is.
  //
  // Errors: UNAUTHENTICATED (no credentials or a wrong token), PERMISSION_DENIED (a certificate of
  //         no listed caller, or a missing role), RESOURCE_EXHAUSTED with RetryInfo (too many
  //         calls); each with an ErrorInfo. No error reveals valid credentials.
  CallPass Admit(const Credentials& credentials, Role role) const;

 private:
  struct KnownCaller {
    Caller caller;
    std::shared_ptr<CallerUsage> usage;  // outlives the list
  };
  using List = std::vector<KnownCaller>;

  std::shared_ptr<const List> list() const;
  // Null if the list has no such caller.
  static const KnownCaller* Find(const List& callers, const Credentials& credentials);

  const common::Clock& clock_;
  mutable common::Mutex mutex_;
  std::shared_ptr<const List> list_ DUET_GUARDED_BY(mutex_) = std::make_shared<const List>();
};

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_ACCESS_CONTROL_H_
