#include "server/service/call_pipeline.h"

#include <arpa/inet.h>
#include <grpc/support/time.h>
#include <netinet/in.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <random>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "model/base/request_id.h"
#include "model/base/sha256.h"
#include "server/common/error_details.h"

namespace duet::server::service {

namespace {

constexpr std::size_t kMaxClientBytes = 256;

std::string Metadata(const grpc::ServerContextBase& context, const std::string& key) {
  const auto found = context.client_metadata().find(key);
  if (found == context.client_metadata().end()) return "";
  return std::string(found->second.data(), found->second.size());
}

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

security::Credentials CredentialsOf(const grpc::ServerContextBase& context) {
  security::Credentials credentials;
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

// Decides like AccessControl::Admit; see CallPipeline.
security::CallPass Admit(const grpc::ServerContextBase& context, security::Role role,
                         const security::AccessControl* access) {
  const security::Credentials credentials = CredentialsOf(context);
  if (access != nullptr) return access->Admit(credentials, role);
  const std::vector<std::string>& names = credentials.certificate_names;
  const bool allowed = role == security::Role::kSynthesise || IsFromThisMachine(context);
  return {allowed ? absl::OkStatus() : security::RoleRefusal(role),
          names.empty() ? "" : names.front()};
}

}  // namespace

OpenedCall CallPipeline::Open(const grpc::ServerContextBase& context,
                              const metrics::MethodInfo& method) const {
  OpenedCall opened;
  opened.scope = std::make_unique<CallScope>(method, observers_, clock_);
  metrics::CallRecord& record = opened.scope->record();
  record.request_id = Metadata(context, "x-request-id");
  if (!base::IsRequestId(record.request_id)) record.request_id = NewRequestId();
  record.traceparent = Metadata(context, "traceparent");
  if (!IsTraceparent(record.traceparent)) record.traceparent.clear();
  record.peer = context.peer();
  security::CallPass pass = Admit(context, role_, access_);
  record.caller = std::move(pass.name);
  record.caller_is_listed = pass.is_listed;
  opened.status = std::move(pass.status);
  // A listed caller is one client, whatever address it calls from.
  if (record.caller_is_listed) {
    opened.client = "caller:" + record.caller;
    return opened;
  }
  if (!client_key_.empty()) opened.client = Metadata(context, client_key_);
  if (opened.client.empty() || opened.client.size() > kMaxClientBytes) {
    opened.client = ClientOf(record.peer);
  }
  return opened;
}

void CallPipeline::Report(CallScope& scope, const absl::Status& status,
                          grpc::ServerContextBase& context) {
  scope.Finish(status);
  common::AddRetryPushback(status, context);
  const std::string& traceparent = scope.record().traceparent;
  if (!traceparent.empty()) context.AddTrailingMetadata("traceparent", traceparent);
}

CallScope::CallScope(const metrics::MethodInfo& method,
                     const std::vector<metrics::CallObserver*>& observers,
                     const common::Clock& clock)
    : observers_(observers), clock_(clock), begin_(clock.Now()) {
  record_.method = method;
  for (metrics::CallObserver* observer : observers_) observer->CallStarted(method);
}

void CallScope::Finish(const absl::Status& status) {
  // A caller that has its status has its share as well.
  record_.status = status;
  record_.total_seconds = ElapsedSeconds();
  for (metrics::CallObserver* observer : observers_) observer->CallFinished(record_);
}

std::string ClientOf(std::string_view peer) {
  const std::size_t port = peer.rfind(':');
  const bool ipv6 = absl::StartsWith({peer.data(), peer.size()}, "ipv6:");
  if (!ipv6 && !absl::StartsWith({peer.data(), peer.size()}, "ipv4:")) return std::string(peer);
  const std::string host(peer.substr(0, port));
  if (!ipv6) return host;
  constexpr std::string_view kOpen = "ipv6:%5B", kClose = "%5D";
  if (host.size() < kOpen.size() + kClose.size()) return host;
  const std::string text = host.substr(kOpen.size(), host.size() - kOpen.size() - kClose.size());
  in6_addr address = {};
  if (inet_pton(AF_INET6, text.c_str(), &address) != 1) return host;
  // An IPv4 client of a dual-stack socket.
  if (IN6_IS_ADDR_V4MAPPED(&address))
    return absl::StrCat("ipv4:", text.substr(text.rfind(':') + 1));
  constexpr std::size_t kNetworkBytes = 8;
  std::fill(address.s6_addr + kNetworkBytes, address.s6_addr + sizeof(address.s6_addr), 0);
  char network[INET6_ADDRSTRLEN] = {};
  inet_ntop(AF_INET6, &address, network, sizeof(network));
  return absl::StrCat("ipv6:", network, "/64");
}

bool IsTraceparent(std::string_view text) {
  // 00-<32 hex>-<16 hex>-<2 hex>
  constexpr std::string_view kShape = "xx-xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx-xxxxxxxxxxxxxxxx-xx";
  return text.size() == kShape.size() &&
         std::equal(text.begin(), text.end(), kShape.begin(), [](unsigned char c, char shape) {
           return shape == '-' ? c == '-' : absl::ascii_isxdigit(c) && !absl::ascii_isupper(c);
         });
}

std::string NewRequestId() {
  thread_local std::mt19937_64 generator = [] {
    std::random_device device;
    std::seed_seq seed{device(), device(), device(), device(), device(), device()};
    return std::mt19937_64(seed);
  }();
  const uint64_t high = generator();
  const uint64_t low = generator();
  return absl::StrCat(absl::Hex(high, absl::kZeroPad16), absl::Hex(low, absl::kZeroPad16));
}

double SecondsLeft(const grpc::ServerContextBase& context) {
  const gpr_timespec deadline = context.raw_deadline();
  if (gpr_time_cmp(deadline, gpr_inf_future(deadline.clock_type)) == 0) {
    return std::numeric_limits<double>::infinity();
  }
  const gpr_timespec left = gpr_time_sub(deadline, gpr_now(deadline.clock_type));
  return static_cast<double>(left.tv_sec) + 1e-9 * left.tv_nsec;
}

}  // namespace duet::server::service
