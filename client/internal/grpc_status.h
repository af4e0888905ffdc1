#ifndef DUET_CLIENT_INTERNAL_GRPC_STATUS_H_
#define DUET_CLIENT_INTERNAL_GRPC_STATUS_H_

#include <memory>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/time/time.h"
#include "grpcpp/client_context.h"
#include "grpcpp/support/status.h"

namespace duet::client::internal {

// Returns the context of one attempt of a call. `token`: the credentials of the caller; empty:
// none. `request_id` may be empty.
std::unique_ptr<grpc::ClientContext> NewContext(absl::Time deadline, const std::string& token,
                                                const std::string& request_id = "");

// Converts a call's status. The result has its google.rpc details as payloads, and its message
// names every field violation, including those that the server's message omits. Details that cannot
// be parsed are dropped, so that they never change the error code.
absl::Status FromGrpc(const grpc::Status& status);

// Returns `status` with `more` appended to its message.
absl::Status AppendMessage(const absl::Status& status, std::string_view more);
// Returns `to` with the payloads of `from`.
absl::Status WithPayloadsOf(const absl::Status& from, absl::Status to);

// Returns true if the connection failed, rather than the service. A proxy or a crashing server
// resets streams with various codes; errors of the service itself always carry an ErrorInfo.
bool IsBrokenConnection(const absl::Status& status);

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_GRPC_STATUS_H_
