#ifndef DUET_CLIENT_LOAD_GRPC_TARGET_H_
#define DUET_CLIENT_LOAD_GRPC_TARGET_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/load/target.h"
#include "client/options.h"

namespace duet::client::load {

// A server, over `connections` connections that calls take in turn. Call kind i asks with
// requests[i], a serialised duet.v1.SynthesizeRequest; every call has the options' deadline, one
// attempt, and no thread of its own. A reply without all its frames ends as INTERNAL.
//
// Returns once every connection is there. Errors: INVALID_ARGUMENT when an option makes no sense,
// UNAVAILABLE when a connection does not come about within the deadline.
absl::StatusOr<std::unique_ptr<Target>> ConnectTarget(const ClientOptions& options, int connections,
                                                      const std::vector<std::string>& requests);

}  // namespace duet::client::load

#endif  // DUET_CLIENT_LOAD_GRPC_TARGET_H_
