#ifndef DUET_CONTRIB_LOAD_SERVER_CALLS_H_
#define DUET_CONTRIB_LOAD_SERVER_CALLS_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/client.h"
#include "client/options.h"
#include "client/request.h"
#include "client/result.h"
#include "contrib/load/calls.h"
#include "grpcpp/channel.h"
#include "model/motion/vec3.h"

namespace duet::contrib::load {

// What every call requests.
struct CallContent {
  client::ModelChoice model;
  int frames = 46;                          // of the leader, at the model's own rate
  std::vector<client::ClassWeight> labels;  // empty: 1 for the model's first class
};

// Where a joint of a generated leader is: a figure that sways. Its motion does not affect the cost
// of a call.
motion::Vec3 SwayingJoint(int frame, int joint);

// A serialised duet.v1.SynthesizeRequest, and the model that answers it.
struct CallRequest {
  std::string model;  // "sbu@3"
  std::string bytes;
};

// Resolves the model at the server, and tries a call, so that rejections are known before
// measuring. Errors: the server's status, except rejections for lack of capacity.
absl::StatusOr<CallRequest> FindRequest(const client::Client& client, const CallContent& content);

// Connections to a server that are established. Errors: INVALID_ARGUMENT for invalid options,
// UNAVAILABLE if one is not established within the deadline.
absl::StatusOr<std::vector<std::shared_ptr<grpc::Channel>>> OpenChannels(
    const client::ClientOptions& options, int connections);

// A server, over `connections` connections that calls use in turn. Every call sends `request`, has
// the options' deadline, one attempt, and no thread of its own. A reply without all its frames ends
// as INTERNAL.
//
// Returns after every connection is established. Errors: INVALID_ARGUMENT for invalid options,
// UNAVAILABLE if a connection is not established within the deadline.
absl::StatusOr<std::unique_ptr<CallTarget>> ConnectCalls(const client::ClientOptions& options,
                                                         int connections,
                                                         const std::string& request);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_SERVER_CALLS_H_
