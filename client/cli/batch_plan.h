#ifndef DUET_CLIENT_CLI_BATCH_PLAN_H_
#define DUET_CLIENT_CLI_BATCH_PLAN_H_

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/batch/plan.h"
#include "client/cli/arguments.h"
#include "client/result.h"

namespace duet::client::cli {

// The plan of the leaders that the flags name; `in` is what a manifest named "-" is read from. What
// was passed over in folders is added to `passed_over`, which may be null.
absl::StatusOr<batch::Plan> MakePlan(const BatchArguments& arguments, const batch::Recipe& recipe,
                                     const std::vector<ModelInfo>& models, std::istream* in,
                                     std::vector<std::string>* passed_over);

// A run reads its leaders twice: to check all of them, and to ask. Copies a manifest named "-" to
// `folder`, for MakePlan to read from there. ABORTED if it cannot be written.
absl::Status CopyManifest(const std::filesystem::path& folder, std::istream* in,
                          BatchArguments* arguments);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_PLAN_H_
