#include "server/service/call_pipeline.h"

#include <string>
#include <utility>

#include "server/common/trace_context.h"
#include "server/service/call_identity.h"
#include "server/service/refusals.h"
#include "server/service/wire.h"

namespace duet::server::service {

std::unique_ptr<CallScope> CallPipeline::OpenScope(const grpc::ServerContextBase& context,
                                                   const metrics::MethodInfo& method) const {
  auto scope = std::make_unique<CallScope>(method, IdentifyCall(context), observers_, clock_);
  metrics::CallRecord& record = scope->record();
  if (auto trace = common::ContinueTrace(record.traceparent)) {
    record.trace = *std::move(trace);
  } else if (trace_ratio_.has_value()) {
    record.trace = common::BeginTrace(*trace_ratio_);
  }
  return scope;
}

void CallPipeline::AddTraceparent(CallScope& scope, grpc::ServerContextBase& context) {
  const std::string traceparent = common::Traceparent(scope.record().trace);
  if (!traceparent.empty()) context.AddTrailingMetadata("traceparent", traceparent);
}

absl::Status CallPipeline::Read(const grpc::ByteBuffer& bytes,
                                google::protobuf::Message& request) const {
  if (bytes.Length() > max_request_bytes_) {
    return TooLargeRefusal(bytes.Length(), max_request_bytes_);
  }
  return ParseMessage(bytes, request);
}

}  // namespace duet::server::service
