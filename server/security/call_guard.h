#ifndef DUET_SERVER_SECURITY_CALL_GUARD_H_
#define DUET_SERVER_SECURITY_CALL_GUARD_H_

#include <grpcpp/server_context.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "server/security/access_control.h"

namespace duet::server::security {

// Whether a call is allowed, and who makes it.
struct CallPass {
  absl::Status status;  // OK, or the reason why the call is rejected
  // The caller's name in the access file, otherwise the first name in its certificate; empty for an
  // unknown caller. A rejected caller can have a name, too.
  std::string name;
  bool is_listed = false;  // in the access file
};

// Identifies the caller of a call by its certificate and its `authorization: Bearer TOKEN`, and
// decides whether the call is allowed.
//
// Without an access list everybody may synthesise, and callers on this machine may administer.
//
// Errors: UNAUTHENTICATED (no credentials or a wrong token), PERMISSION_DENIED (a certificate of no
//         listed caller, or a missing role), RESOURCE_EXHAUSTED with RetryInfo (too many calls);
//         each with an ErrorInfo. No error reveals valid credentials.
// Threads: safe to call concurrently.
class CallGuard {
 public:
  // `access` outlives the guard; null: no list.
  explicit CallGuard(const AccessControl* access) : access_(access) {}

  CallPass Admit(const grpc::ServerContextBase& context, Role role) const;

 private:
  const AccessControl* access_;
};

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_CALL_GUARD_H_
