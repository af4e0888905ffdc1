#include "server/service/call_identity.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"

namespace duet::server::service {
namespace {

constexpr std::size_t kMaxRequestIdBytes = 128;

std::string Metadata(const grpc::ServerContextBase& context, const char* key) {
  const auto found = context.client_metadata().find(key);
  if (found == context.client_metadata().end()) return "";
  return std::string(found->second.data(), found->second.size());
}

}  // namespace

CallIdentity IdentifyCall(const grpc::ServerContextBase& context) {
  CallIdentity identity;
  identity.request_id = Metadata(context, "x-request-id");
  if (!IsRequestId(identity.request_id)) identity.request_id = NewRequestId();
  identity.traceparent = Metadata(context, "traceparent");
  if (!IsTraceparent(identity.traceparent)) identity.traceparent.clear();
  identity.peer = context.peer();
  return identity;
}

bool IsRequestId(std::string_view text) {
  return !text.empty() && text.size() <= kMaxRequestIdBytes &&
         std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return absl::ascii_isgraph(c); });
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

}  // namespace duet::server::service
