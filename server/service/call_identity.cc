#include "server/service/call_identity.h"

#include <arpa/inet.h>
#include <grpc/support/time.h>
#include <netinet/in.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "model/base/request_id.h"

namespace duet::server::service {
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
