#include "server/security/access_control.h"

#include <openssl/crypto.h>

#include <algorithm>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/time/time.h"
#include "server/common/error_details.h"

namespace duet::server::security {
namespace {

absl::Status UnknownCaller(const Credentials& credentials) {
  if (credentials.has_token) {
    return common::WithInfo(
        absl::UnauthenticatedError(
            "authorization: expected \"Bearer TOKEN\" with a token known here, got another"),
        common::kReasonCredentialsInvalid);
  }
  if (!credentials.certificate_names.empty()) {
    return common::WithInfo(absl::PermissionDeniedError(
                                "expected a client certificate of a listed caller, got another"),
                            common::kReasonCallerUnknown);
  }
  return common::WithInfo(
      absl::UnauthenticatedError(
          "expected \"authorization: Bearer TOKEN\" in the call's metadata, or a client "
          "certificate where the server asks for one, got neither"),
      common::kReasonCredentialsMissing);
}

// Counts the call.
absl::Status CheckRate(double calls_per_second, CallerUsage& usage, common::TimePoint now) {
  const std::optional<double> wait = usage.TakeCall(calls_per_second, now);
  if (!wait.has_value()) return absl::OkStatus();
  const std::string limit = absl::StrCat(calls_per_second);
  absl::Status status = absl::ResourceExhaustedError(
      absl::StrCat("expected at most ", limit, " calls per second from this caller, got more"));
  common::AddRetryInfo(status, absl::Seconds(*wait));
  return common::WithInfo(std::move(status), common::kReasonCallRate,
                          {{"calls_per_second", limit}});
}

}  // namespace

absl::Status RoleRefusal(Role role) {
  return common::WithInfo(absl::PermissionDeniedError(
                              absl::StrCat("the caller does not have the role ", RoleName(role))),
                          common::kReasonRoleMissing, {{"role", RoleName(role)}});
}

std::optional<double> CallerUsage::TakeCall(double per_second, common::TimePoint now) {
  const double most = std::max(1.0, per_second);
  common::MutexLock lock(mutex_);
  // Threads read the clock before they get the lock, so `now` may be a little old.
  const double passed =
      counted_.has_value() ? std::max(0.0, common::SecondsBetween(*counted_, now)) : 0;
  tokens_ = counted_.has_value() ? std::min(most, tokens_ + passed * per_second) : most;
  counted_ = counted_.has_value() ? std::max(*counted_, now) : now;
  if (tokens_ < 1) return (1 - tokens_) / per_second;
  tokens_ -= 1;
  return std::nullopt;
}

void AccessControl::Replace(std::vector<Caller> callers) {
  auto next = std::make_shared<List>();
  common::MutexLock lock(mutex_);
  std::map<std::string, std::shared_ptr<CallerUsage>> used;
  for (const KnownCaller& known : *list_) used[known.caller.name] = known.usage;
  for (Caller& caller : callers) {
    std::shared_ptr<CallerUsage>& usage = used[caller.name];
    if (usage == nullptr) usage = std::make_shared<CallerUsage>();
    next->push_back({std::move(caller), usage});
  }
  list_ = std::move(next);
}

const AccessControl::KnownCaller* AccessControl::Find(const List& callers,
                                                      const Credentials& credentials) {
  const KnownCaller* found = nullptr;
  for (const KnownCaller& known : callers) {
    if (!credentials.has_token) {
      // Names in certificates are not secret.
      const std::vector<std::string>& names = known.caller.certificate_names;
      if (std::find_first_of(names.begin(), names.end(), credentials.certificate_names.begin(),
                             credentials.certificate_names.end()) != names.end()) {
        return &known;
      }
      continue;
    }
    // Compares every digest of every caller, found or not, so that the time reveals nothing of the
    // list.
    for (const std::string& digest : known.caller.token_digests) {
      if (digest.size() == credentials.token_digest.size() &&
          CRYPTO_memcmp(digest.data(), credentials.token_digest.data(), digest.size()) == 0) {
        found = &known;
      }
    }
  }
  return found;
}

CallPass AccessControl::Admit(const Credentials& credentials, Role role) const {
  const std::shared_ptr<const List> callers = list();
  const KnownCaller* const known = Find(*callers, credentials);
  if (known == nullptr) {
    const std::vector<std::string>& names = credentials.certificate_names;
    return {UnknownCaller(credentials), names.empty() ? "" : names.front()};
  }
  const Caller& caller = known->caller;
  CallPass pass{absl::OkStatus(), caller.name, /*is_listed=*/true};
  if (caller.roles.count(role) == 0) {
    pass.status = RoleRefusal(role);
  } else if (caller.calls_per_second.has_value()) {
    pass.status = CheckRate(*caller.calls_per_second, *known->usage, clock_.Now());
  }
  return pass;
}

std::shared_ptr<const AccessControl::List> AccessControl::list() const {
  common::MutexLock lock(mutex_);
  return list_;
}

}  // namespace duet::server::security
