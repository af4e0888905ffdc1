#ifndef DUET_CLIENT_CLI_OUTPUT_H_
#define DUET_CLIENT_CLI_OUTPUT_H_

#include <filesystem>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/request.h"
#include "client/result.h"
#include "model/motion/skeleton.h"

namespace duet::client::cli {

// A finished synthesis, with everything that any kind of output shows of it.
struct Synthesis {
  SynthesisRequest request;
  SynthesisResult result;
  motion::Skeleton skeleton;
  std::filesystem::path leader_file;
  bool sampled = false;  // the model samples: the follower is one of several
};

// Whether an output can be written at all, before any work is done for it: a known extension, a
// folder that exists, and not the leader's own file. INVALID_ARGUMENT.
absl::Status CheckOutput(const std::filesystem::path& output, const std::filesystem::path& leader);

// Writes the pair as the extension says, whole files or none, and returns them (.bvh makes two).
absl::StatusOr<std::vector<std::filesystem::path>> WriteOutput(const std::filesystem::path& output,
                                                               const Synthesis& synthesis);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_OUTPUT_H_
