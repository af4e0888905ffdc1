#include "server/service/live_inbox.h"

#include <cstddef>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "duet/v1/live.pb.h"
#include "server/service/refusals.h"
#include "server/service/wire.h"

namespace duet::server::service {
namespace {

// Far above ten seconds of any skeleton at any rate.
constexpr std::size_t kMaxMessageBytes = std::size_t{1} << 20;

absl::StatusOr<v1::SynthesizeLiveRequest> Parse(grpc::ByteBuffer bytes) {
  if (bytes.Length() > kMaxMessageBytes) {
    return LiveMessageTooLargeRefusal(bytes.Length(), kMaxMessageBytes);
  }
  v1::SynthesizeLiveRequest message;
  const absl::Status parsed = ParseMessage(std::move(bytes), message);
  if (!parsed.ok()) return parsed;
  return message;
}

}  // namespace

void LiveInbox::OnMessage(grpc::ByteBuffer bytes) { session_->OnMessage(Parse(std::move(bytes))); }

}  // namespace duet::server::service
