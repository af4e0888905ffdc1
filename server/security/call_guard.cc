#include "server/security/call_guard.h"

#include <iterator>
#include <map>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "absl/time/time.h"
#include "model/base/sha256.h"
#include "server/common/error_details.h"

namespace duet::server::security {
namespace {

std::vector<std::string> CertificateNames(const grpc::ServerContextBase& context) {
  std::vector<std::string> names;
  const auto authenticated = context.auth_context();
  if (authenticated == nullptr || !authenticated->IsPeerAuthenticated()) return names;
  // The subject's alternative names, or its common name if there are none.
  for (const grpc::string_ref& name : authenticated->GetPeerIdentity()) {
    names.emplace_back(name.data(), name.size());
  }
  return names;
}

// The token of "Bearer TOKEN"; empty for anything else.
absl::string_view BearerToken(absl::string_view authorization) {
  constexpr absl::string_view kScheme = "Bearer ";
  return absl::StartsWithIgnoreCase(authorization, kScheme) ? authorization.substr(kScheme.size())
                                                            : absl::string_view();
}

Credentials CredentialsOf(const grpc::ServerContextBase& context) {
  Credentials credentials;
  credentials.certificate_names = CertificateNames(context);
  const auto [begin, end] = context.client_metadata().equal_range("authorization");
  if (begin == end) return credentials;
  credentials.has_token = true;
  if (std::next(begin) != end) return credentials;  // several: ambiguous
  const absl::string_view token = BearerToken({begin->second.data(), begin->second.size()});
  if (!token.empty()) credentials.token_digest = base::Sha256Hex({token.data(), token.size()});
  return credentials;
}

bool IsFromThisMachine(const grpc::ServerContextBase& context) {
  const std::string peer = context.peer();
  return absl::StartsWith(peer, "ipv4:127.") || absl::StartsWith(peer, "ipv6:%5B::1%5D:") ||
         absl::StartsWith(peer, "ipv6:[::1]:") || absl::StartsWith(peer, "unix:");
}

absl::Status RoleRefusal(Role role) {
  return common::WithInfo(absl::PermissionDeniedError(
                              absl::StrCat("the caller does not have the role ", RoleName(role))),
                          common::kReasonRoleMissing, {{"role", RoleName(role)}});
}

absl::Status ToStatus(const AccessControl::Decision& decision, Role role) {
  switch (decision.answer) {
    case AccessControl::Answer::kAllowed:
      break;
    case AccessControl::Answer::kNoCredentials:
      return common::WithInfo(
          absl::UnauthenticatedError(
              "expected \"authorization: Bearer TOKEN\" in the call's metadata, or a client "
              "certificate where the server asks for one, got neither"),
          common::kReasonCredentialsMissing);
    case AccessControl::Answer::kWrongToken:
      return common::WithInfo(
          absl::UnauthenticatedError(
              "authorization: expected \"Bearer TOKEN\" with a token known here, got another"),
          common::kReasonCredentialsInvalid);
    case AccessControl::Answer::kUnknownCertificate:
      return common::WithInfo(absl::PermissionDeniedError(
                                  "expected a client certificate of a listed caller, got another"),
                              common::kReasonCallerUnknown);
    case AccessControl::Answer::kWrongRole:
      return RoleRefusal(role);
    case AccessControl::Answer::kTooManyCalls: {
      const std::string limit = absl::StrCat(*decision.caller->caller.calls_per_second);
      absl::Status status = absl::ResourceExhaustedError(
          absl::StrCat("expected at most ", limit, " calls per second from this caller, got more"));
      common::AddRetryInfo(status, absl::Seconds(decision.retry_seconds));
      return common::WithInfo(std::move(status), common::kReasonCallRate,
                              {{"calls_per_second", limit}});
    }
  }
  return absl::OkStatus();
}

}  // namespace

CallPass CallGuard::Admit(const grpc::ServerContextBase& context, Role role) const {
  const Credentials credentials = CredentialsOf(context);
  const std::vector<std::string>& names = credentials.certificate_names;
  const std::string certificate = names.empty() ? "" : names.front();
  if (access_ == nullptr) {
    const bool allowed = role == Role::kSynthesise || IsFromThisMachine(context);
    return {allowed ? absl::OkStatus() : RoleRefusal(role), certificate};
  }
  const AccessControl::Decision decision = access_->Decide(credentials, role);
  const bool is_listed = decision.caller != nullptr;
  return {ToStatus(decision, role), is_listed ? decision.caller->caller.name : certificate,
          is_listed};
}

}  // namespace duet::server::security
