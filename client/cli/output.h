#ifndef DUET_CLIENT_CLI_OUTPUT_H_
#define DUET_CLIENT_CLI_OUTPUT_H_

#include <filesystem>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/motion_input.h"
#include "client/request.h"
#include "client/result.h"
#include "model/formats/motion_file.h"
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

enum class OutputKind { kMotion, kPage, kEither };
// Checks that an output can be written, before any work is done for it: an extension of its kind, a
// folder that exists, and neither a folder nor one of the files that are read, which may be empty.
// Errors: INVALID_ARGUMENT.
absl::Status CheckOutput(const std::filesystem::path& output,
                         const std::vector<std::filesystem::path>& inputs,
                         OutputKind kind = OutputKind::kEither);
// ABORTED if the file cannot be created now, as on a read-only disk. For outputs that are written
// long after the work began: creates a file beside it, and removes it.
absl::Status CheckCanCreate(const std::filesystem::path& output);

// Writes the pair as the extension says, whole files or none, and returns them (.bvh makes two).
absl::StatusOr<std::vector<std::filesystem::path>> WriteOutput(const std::filesystem::path& output,
                                                               const Synthesis& synthesis);
// Writes only the follower, as one file; a page shows both.
absl::Status WriteFollower(const std::filesystem::path& output, const Synthesis& synthesis);
// ABORTED instead of PERMISSION_DENIED: a disk may be full or a folder closed for a while, so the
// same call may succeed later.
absl::Status NotWritten(const absl::Status& status);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_OUTPUT_H_
