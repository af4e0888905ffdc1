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

// The result of admitting a call: whether it is allowed, its caller if known, and the frames that
// it holds of the caller's limit.
//
// Threads: not safe to call concurrently.
class CallPass {
 public:
  CallPass() = default;  // for a call without limits
  CallPass(absl::Status status, std::string name, std::shared_ptr<const KnownCaller> caller)
      : status_(std::move(status)), name_(std::move(name)), caller_(std::move(caller)) {}

  // OK, or the reason why the call is rejected.
  const absl::Status& status() const { return status_; }
  // The caller's name in the access file, otherwise the first name in its certificate; empty for an
  // unknown caller. A rejected caller can have a name, too.
  const std::string& name() const { return name_; }

  bool is_listed() const { return caller_ != nullptr; }

  // Counts frames against the caller's limit, until Release or the end of the pass.
  // Fails with RESOURCE_EXHAUSTED if that exceeds the limit, with RetryInfo unless the frames alone
  // do.
  absl::Status HoldFrames(std::int64_t frames);
  void Release() { frames_ = FrameLease(); }

 private:
  absl::Status status_;
  std::string name_;
  std::shared_ptr<const KnownCaller> caller_;
  FrameLease frames_;
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
