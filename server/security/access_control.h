#ifndef DUET_SERVER_SECURITY_ACCESS_CONTROL_H_
#define DUET_SERVER_SECURITY_ACCESS_CONTROL_H_

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "server/common/clock.h"
#include "server/common/mutex.h"
#include "server/security/caller.h"
#include "server/security/caller_usage.h"

namespace duet::server::security {

// By what a call says who makes it.
struct Credentials {
  bool has_token = false;    // whether it carries an authorization at all
  std::string token_digest;  // SHA-256 of its token; empty for an authorization of another kind
  std::vector<std::string> certificate_names;  // of a certificate that TLS has verified
};

// A caller with what it uses, which outlives the list that it stands in.
struct KnownCaller {
  Caller caller;
  std::shared_ptr<CallerUsage> usage;
};

// Who may do what: a list that is replaced as a whole while calls go on.
//
// Threads: safe to call concurrently. Uses neither gRPC nor abseil.
class AccessControl {
 public:
  enum class Answer {
    kAllowed,
    kNoCredentials,
    kWrongToken,
    kUnknownCertificate,  // verified, but nobody's on the list
    kWrongRole,
    kTooManyCalls,
  };
  struct Decision {
    Answer answer = Answer::kNoCredentials;
    std::shared_ptr<const KnownCaller> caller;  // null until it is known who calls
    double retry_seconds = 0;                   // of kTooManyCalls
  };

  // `clock` outlives the control.
  explicit AccessControl(const common::Clock& clock) : clock_(clock) {}

  // From now on these callers, and no others. Those that stay keep what they use.
  void Replace(std::vector<Caller> callers);

  // Finds out who calls, and counts the call when it may go on. A token decides where there is one:
  // a wrong one is refused whatever the certificate says.
  Decision Decide(const Credentials& credentials, Role role) const;

  std::size_t callers() const;

 private:
  using List = std::vector<std::shared_ptr<const KnownCaller>>;
  std::shared_ptr<const List> list() const;

  const common::Clock& clock_;
  mutable common::Mutex mutex_;
  std::shared_ptr<const List> list_ DUET_GUARDED_BY(mutex_) = std::make_shared<const List>();
};

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_ACCESS_CONTROL_H_
