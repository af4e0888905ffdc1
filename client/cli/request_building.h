#ifndef DUET_CLIENT_CLI_REQUEST_BUILDING_H_
#define DUET_CLIENT_CLI_REQUEST_BUILDING_H_

#include <istream>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/arguments.h"
#include "client/request.h"
#include "model/formats/follower_rig.h"
#include "model/motion/skeleton.h"

namespace duet::client::cli {

// Whether the files that the flags name exist and are of a known kind. Needs no skeleton, so that a
// wrong name is refused before the server is asked for its model.
absl::Status CheckInputs(const SynthesizeArguments& arguments);

// The request that the flags describe; reads the files that they name, in the skeleton's joints.
// `notes` receives what was decided where the leader's file leaves a choice; a leader `-` is read
// from `in`.
absl::StatusOr<SynthesisRequest> BuildRequest(const SynthesizeArguments& arguments,
                                              const motion::Skeleton& skeleton,
                                              std::vector<std::string>* notes,
                                              std::istream* in = nullptr);

// The rig that the follower is written onto. The leader's is read as the leader was.
absl::StatusOr<formats::FollowerRig> BuildFollowerRig(const SynthesizeArguments& arguments,
                                                      const motion::Skeleton& skeleton);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_REQUEST_BUILDING_H_
