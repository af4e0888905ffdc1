#ifndef DUET_CLIENT_CLI_REQUEST_BUILDING_H_
#define DUET_CLIENT_CLI_REQUEST_BUILDING_H_

#include <istream>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/synthesize_arguments.h"
#include "client/request.h"
#include "client/result.h"
#include "model/formats/follower_rig.h"
#include "model/motion/skeleton.h"

namespace duet::client::cli {

// Checks that the files of the flags exist and have a known format. Needs no skeleton, so that a
// wrong name is rejected before the first call to the server.
absl::Status CheckInputs(const SynthesizeArguments& arguments);

// Rejects a class that the model does not know and suggests the nearest name.
absl::Status CheckLabels(const SynthesizeArguments& arguments, const ModelInfo& model);

// Builds a request without a leader, from flags without positions in beats.
absl::StatusOr<SynthesisRequest> BuildReaction(const SynthesizeArguments& arguments,
                                               const motion::Skeleton& skeleton);

// Builds the request that the flags describe, with the motions of their files in the skeleton's
// joints. `notes` receives the choices that were made while reading the leader. A leader `-` is
// read from `in`.
absl::StatusOr<SynthesisRequest> BuildRequest(const SynthesizeArguments& arguments,
                                              const motion::Skeleton& skeleton,
                                              std::vector<std::string>* notes,
                                              std::istream* in = nullptr);

// The rig for the follower. The leader's rig is read with the leader's flags. `notes` receives the
// choices that were made while reading another rig.
absl::StatusOr<formats::FollowerRig> BuildFollowerRig(const SynthesizeArguments& arguments,
                                                      const motion::Skeleton& skeleton,
                                                      std::vector<std::string>* notes);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_REQUEST_BUILDING_H_
