#ifndef DUET_CLIENT_INTERNAL_GRPC_STATUS_H_
#define DUET_CLIENT_INTERNAL_GRPC_STATUS_H_

#include <string_view>

#include "absl/status/status.h"
#include "grpcpp/support/status.h"

namespace duet::client::internal {

// A call's status with its google.rpc details as payloads. The message names every field violation
// that the server's own text leaves out. Details that cannot be read are dropped: they never turn
// a refusal into another error.
absl::Status FromGrpc(const grpc::Status& status);

// The same code and payloads, with `more` after the message.
absl::Status AppendMessage(const absl::Status& status, std::string_view more);
// The same payloads under another code and message.
absl::Status WithPayloadsOf(const absl::Status& from, absl::Status to);

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_GRPC_STATUS_H_
