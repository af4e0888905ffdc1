#ifndef DUET_CONTRIB_LOAD_GRPC_TARGET_H_
#define DUET_CONTRIB_LOAD_GRPC_TARGET_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/options.h"
#include "contrib/load/target.h"

namespace duet::contrib::load {

// A server, over `connections` connections that calls use in turn. Call kind i sends requests[i], a
// serialised duet.v1.SynthesizeRequest; every call has the options' deadline, one attempt, and no
// thread of its own. A reply without all its frames ends as INTERNAL.
//
// Returns after every connection is established. Errors: INVALID_ARGUMENT for invalid options,
// UNAVAILABLE if a connection is not established within the deadline.
absl::StatusOr<std::unique_ptr<Target>> ConnectTarget(const client::ClientOptions& options,
                                                      int connections,
                                                      const std::vector<std::string>& requests);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_GRPC_TARGET_H_
