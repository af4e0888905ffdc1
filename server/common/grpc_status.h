#ifndef DUET_SERVER_COMMON_GRPC_STATUS_H_
#define DUET_SERVER_COMMON_GRPC_STATUS_H_

#include <grpcpp/server_context.h>
#include <grpcpp/support/status.h>

#include "absl/status/status.h"

namespace duet::server::common {

// Converts a status for the wire; the only place that does. Code and message stay as they are,
// payloads become google.rpc.Status in grpc-status-details-bin.
grpc::Status ToGrpcStatus(const absl::Status& status);

// Sends the delay of the status's RetryInfo as grpc-retry-pushback-ms, which gRPC's built-in
// retries follow. Does nothing if the status has no RetryInfo.
void AddRetryPushback(const absl::Status& status, grpc::ServerContextBase& context);

}  // namespace duet::server::common

#endif  // DUET_SERVER_COMMON_GRPC_STATUS_H_
