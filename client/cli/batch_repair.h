#ifndef DUET_CLIENT_CLI_BATCH_REPAIR_H_
#define DUET_CLIENT_CLI_BATCH_REPAIR_H_

#include <filesystem>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/batch/job_folder.h"
#include "client/batch/shard.h"
#include "client/cli/batch_arguments.h"

namespace duet::client::cli {

// Stores the command of a run and the folder where it was started in the data set, so that
// `duet batch verify --repair` can repeat it. Errors: those of durable_file.h.
absl::Status KeepCommand(const BatchArguments& arguments, const batch::Shard& shard,
                         const batch::JobFolder& folder);

// The command of the last run of the data set of `verify`. Its paths are relative to the folder
// where it was started, which EnterFolderOf makes the current folder. FAILED_PRECONDITION if there
// is none, or if its leaders came from a pipe.
absl::StatusOr<BatchArguments> CommandOf(const BatchArguments& verify);
absl::Status EnterFolderOf(const std::filesystem::path& out);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_REPAIR_H_
