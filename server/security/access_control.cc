#include "server/security/access_control.h"

#include <openssl/crypto.h>

#include <algorithm>

namespace duet::server::security {
namespace {

using Callers = std::vector<std::shared_ptr<const KnownCaller>>;

// Compares every digest of every caller, found or not, so that the time reveals nothing of the
// list.
std::shared_ptr<const KnownCaller> FindByToken(const Callers& callers, const std::string& digest) {
  std::shared_ptr<const KnownCaller> found;
  for (const auto& known : callers) {
    for (const std::string& theirs : known->caller.token_digests) {
      if (theirs.size() == digest.size() &&
          CRYPTO_memcmp(theirs.data(), digest.data(), digest.size()) == 0) {
        found = known;
      }
    }
  }
  return found;
}

// Names in certificates are not secret.
std::shared_ptr<const KnownCaller> FindByCertificate(const Callers& callers,
                                                     const std::vector<std::string>& names) {
  for (const auto& known : callers) {
    const std::vector<std::string>& theirs = known->caller.certificate_names;
    if (std::find_first_of(theirs.begin(), theirs.end(), names.begin(), names.end()) !=
        theirs.end()) {
      return known;
    }
  }
  return nullptr;
}

}  // namespace

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
  for (const auto& known : *list_) used[known->caller.name] = known->usage;
  for (Caller& caller : callers) {
    std::shared_ptr<CallerUsage>& usage = used[caller.name];
    if (usage == nullptr) usage = std::make_shared<CallerUsage>();
    next->push_back(std::make_shared<const KnownCaller>(KnownCaller{std::move(caller), usage}));
  }
  list_ = std::move(next);
}

AccessControl::Decision AccessControl::Decide(const Credentials& credentials, Role role) const {
  const std::shared_ptr<const List> callers = list();
  Decision decision;
  if (credentials.has_token) {
    decision.caller = FindByToken(*callers, credentials.token_digest);
    decision.answer = Answer::kWrongToken;
  } else if (!credentials.certificate_names.empty()) {
    decision.caller = FindByCertificate(*callers, credentials.certificate_names);
    decision.answer = Answer::kUnknownCertificate;
  }
  if (decision.caller == nullptr) return decision;
  const Caller& caller = decision.caller->caller;
  decision.answer = Answer::kAllowed;
  if (caller.roles.count(role) == 0) {
    decision.answer = Answer::kWrongRole;
  } else if (caller.calls_per_second.has_value()) {
    const auto wait = decision.caller->usage->TakeCall(*caller.calls_per_second, clock_.Now());
    decision.retry_seconds = wait.value_or(0);
    if (wait.has_value()) decision.answer = Answer::kTooManyCalls;
  }
  return decision;
}

std::shared_ptr<const AccessControl::List> AccessControl::list() const {
  common::MutexLock lock(mutex_);
  return list_;
}

}  // namespace duet::server::security
