#ifndef DUET_CONTRIB_LOAD_CHANNELS_H_
#define DUET_CONTRIB_LOAD_CHANNELS_H_

#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "client/options.h"
#include "grpcpp/channel.h"

namespace duet::contrib::load {

// Connections to a server that are established. Errors: INVALID_ARGUMENT for invalid options,
// UNAVAILABLE if one is not established within the deadline.
absl::StatusOr<std::vector<std::shared_ptr<grpc::Channel>>> OpenChannels(
    const client::ClientOptions& options, int connections);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_CHANNELS_H_
