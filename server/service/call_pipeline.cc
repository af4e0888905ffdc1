#include "server/service/call_pipeline.h"

#include <arpa/inet.h>
#include <grpc/support/time.h>
#include <netinet/in.h>

#include <algorithm>
#include <limits>
#include <random>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "model/base/request_id.h"
#include "server/common/error_details.h"
#include "server/service/refusals.h"
#include "server/service/wire.h"

namespace duet::server::service {

OpenedCall CallPipeline::Open(const grpc::ServerContextBase& context,
                              const metrics::MethodInfo& method) const {
  CallIdentity identity = IdentifyCall(context, client_key_);
  OpenedCall opened;
  opened.client = identity.client;
  opened.scope = std::make_unique<CallScope>(method, std::move(identity), observers_, clock_);
  security::CallPass pass = guard_.Admit(context, role_);
  metrics::CallRecord& record = opened.scope->record();
  record.caller = std::move(pass.name);
  record.caller_is_listed = pass.is_listed;
  opened.status = std::move(pass.status);
  // A listed caller is one client, whatever address it calls from.
  if (record.caller_is_listed) opened.client = "caller:" + record.caller;
  return opened;
}

void CallPipeline::Report(CallScope& scope, const absl::Status& status,
                          grpc::ServerContextBase& context) {
  scope.Finish(status);
  common::AddRetryPushback(status, context);
  const std::string& traceparent = scope.record().traceparent;
  if (!traceparent.empty()) context.AddTrailingMetadata("traceparent", traceparent);
}

absl::Status CallPipeline::CheckSize(const grpc::ByteBuffer& bytes, std::size_t max_bytes) const {
  const std::size_t length = bytes.Length();
  if (length > max_request_bytes_) return TooLargeRefusal(length, max_request_bytes_);
  if (length > max_bytes) return LiveMessageTooLargeRefusal(length, max_bytes);
  return absl::OkStatus();
}

// By value, so that the bytes are freed as soon as they are parsed.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
absl::Status CallPipeline::Read(grpc::ByteBuffer bytes, google::protobuf::Message& request) const {
  const absl::Status fits = CheckSize(bytes);
  return fits.ok() ? ParseMessage(std::move(bytes), request) : fits;
}

CallScope::CallScope(const metrics::MethodInfo& method, CallIdentity identity,
                     const std::vector<metrics::CallObserver*>& observers,
                     const common::Clock& clock)
    : observers_(observers), clock_(clock), begin_(clock.Now()) {
  record_.method = method;
  record_.request_id = std::move(identity.request_id);
  record_.traceparent = std::move(identity.traceparent);
  record_.peer = std::move(identity.peer);
  for (metrics::CallObserver* observer : observers_) observer->CallStarted(method);
}

void CallScope::Finish(const absl::Status& status) {
  // A caller that has its status has its share as well.
  record_.status = status;
  record_.total_seconds = ElapsedSeconds();
  for (metrics::CallObserver* observer : observers_) observer->CallFinished(record_);
}

namespace {

constexpr std::size_t kMaxClientBytes = 256;

std::string Metadata(const grpc::ServerContextBase& context, const std::string& key) {
  const auto found = context.client_metadata().find(key);
  if (found == context.client_metadata().end()) return "";
  return std::string(found->second.data(), found->second.size());
}

}  // namespace

CallIdentity IdentifyCall(const grpc::ServerContextBase& context, const std::string& client_key) {
  CallIdentity identity;
  identity.request_id = Metadata(context, "x-request-id");
  if (!base::IsRequestId(identity.request_id)) identity.request_id = NewRequestId();
  identity.traceparent = Metadata(context, "traceparent");
  if (!IsTraceparent(identity.traceparent)) identity.traceparent.clear();
  identity.peer = context.peer();
  if (!client_key.empty()) identity.client = Metadata(context, client_key);
  if (identity.client.empty() || identity.client.size() > kMaxClientBytes) {
    identity.client = ClientOf(identity.peer);
  }
  return identity;
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
