#ifndef DUET_SERVER_SECURITY_CALL_GUARD_H_
#define DUET_SERVER_SECURITY_CALL_GUARD_H_

#include <grpcpp/server_context.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "server/security/access_control.h"
#include "server/security/caller.h"

namespace duet::server::security {

// A call at the door: whether it may go on, who makes it as far as that is known, and what it holds
// of its caller's share.
//
// Threads: not safe to call concurrently.
class CallPass {
 public:
  CallPass() = default;  // of a call that is limited by nothing
  CallPass(absl::Status status, std::string name, std::shared_ptr<const KnownCaller> caller)
      : status_(std::move(status)), name_(std::move(name)), caller_(std::move(caller)) {}

  // OK, or why it may not go on.
  const absl::Status& status() const { return status_; }
  // The caller's name in the access file, or else the first of its certificate; empty for somebody
  // unknown. A refused caller has one too.
  const std::string& name() const { return name_; }

  bool is_listed() const { return caller_ != nullptr; }

  // Takes frames of the caller's share, until Release or the end of the pass.
  // RESOURCE_EXHAUSTED when it has not so many left, with RetryInfo unless it never will.
  absl::Status HoldFrames(std::int64_t frames);
  void Release() { frames_ = FrameLease(); }

 private:
  absl::Status status_;
  std::string name_;
  std::shared_ptr<const KnownCaller> caller_;
  FrameLease frames_;
};

// The door: tells from a call's certificate and its `authorization: Bearer TOKEN` who makes it, and
// whether they may.
//
// Without an access list everybody may synthesise, and whoever calls from this machine may
// administer.
//
// Errors: UNAUTHENTICATED (nobody, or a wrong token), PERMISSION_DENIED (a certificate of nobody on
//         the list, a role that the caller has not), RESOURCE_EXHAUSTED with RetryInfo (more calls
//         than it may make); each with an ErrorInfo, none telling what would have been right.
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
