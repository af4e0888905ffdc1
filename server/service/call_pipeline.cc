#include "server/service/call_pipeline.h"

#include "server/service/call_identity.h"
#include "server/service/refusals.h"
#include "server/service/wire.h"

namespace duet::server::service {

std::unique_ptr<CallScope> CallPipeline::OpenScope(const grpc::ServerContextBase& context,
                                                   const metrics::MethodInfo& method) const {
  return std::make_unique<CallScope>(method, IdentifyCall(context), observers_, clock_);
}

absl::Status CallPipeline::Read(const grpc::ByteBuffer& bytes,
                                google::protobuf::Message& request) const {
  if (bytes.Length() > max_request_bytes_) {
    return TooLargeRefusal(bytes.Length(), max_request_bytes_);
  }
  return ParseMessage(bytes, request);
}

}  // namespace duet::server::service
