#ifndef DUET_CLIENT_CLI_BATCH_PLAN_H_
#define DUET_CLIENT_CLI_BATCH_PLAN_H_

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/batch/plan.h"
#include "client/cli/batch_arguments.h"
#include "client/result.h"

namespace duet::client::cli {

// The leaders that the flags name. A manifest "-" is read from `in`. `passed_over`, which may be
// null, receives the files in folders that are not motions.
absl::StatusOr<std::unique_ptr<batch::LeaderSource>> OpenLeaders(
    const BatchArguments& arguments, const batch::Recipe& recipe, std::istream* in,
    std::vector<std::string>* passed_over);

// The plan of the leaders that the flags name. Arguments as of OpenLeaders.
absl::StatusOr<batch::Plan> MakePlan(const BatchArguments& arguments, const batch::Recipe& recipe,
                                     const std::vector<ModelInfo>& models, std::istream* in,
                                     std::vector<std::string>* passed_over);

// Copies a manifest "-" to `folder`, from where MakePlan reads it: a run walks its plan several
// times. ABORTED if the copy cannot be written.
absl::Status CopyManifest(const std::filesystem::path& folder, std::istream* in,
                          BatchArguments* arguments);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_PLAN_H_
