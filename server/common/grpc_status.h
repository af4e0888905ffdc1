#ifndef DUET_SERVER_COMMON_GRPC_STATUS_H_
#define DUET_SERVER_COMMON_GRPC_STATUS_H_

#include <grpcpp/server_context.h>
#include <grpcpp/support/status.h>

#include "absl/status/status.h"

namespace duet::server::common {

// The one place where a status goes on the wire: code and message as they are, payloads as
// google.rpc.Status in grpc-status-details-bin.
grpc::Status ToGrpcStatus(const absl::Status& status);

// Tells gRPC's own retry machinery what RetryInfo tells people: when to come back
// (grpc-retry-pushback-ms). Nothing when the status carries no RetryInfo.
void AddRetryPushback(const absl::Status& status, grpc::ServerContextBase& context);

}  // namespace duet::server::common

#endif  // DUET_SERVER_COMMON_GRPC_STATUS_H_
