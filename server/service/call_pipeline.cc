#include "server/service/call_pipeline.h"

#include <utility>

#include "server/service/call_identity.h"
#include "server/service/refusals.h"
#include "server/service/wire.h"

namespace duet::server::service {

OpenedCall CallPipeline::Open(const grpc::ServerContextBase& context,
                              const metrics::MethodInfo& method) const {
  CallIdentity identity = IdentifyCall(context, client_key_);
  std::string client = identity.client;
  return {std::make_unique<CallScope>(method, std::move(identity), observers_, clock_),
          std::move(client)};
}

absl::Status CallPipeline::CheckSize(const grpc::ByteBuffer& bytes) const {
  if (bytes.Length() <= max_request_bytes_) return absl::OkStatus();
  return TooLargeRefusal(bytes.Length(), max_request_bytes_);
}

// By value, so that the caller's bytes go as soon as they are read.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
absl::Status CallPipeline::Read(grpc::ByteBuffer bytes, google::protobuf::Message& request) const {
  const absl::Status fits = CheckSize(bytes);
  return fits.ok() ? ParseMessage(std::move(bytes), request) : fits;
}

}  // namespace duet::server::service
