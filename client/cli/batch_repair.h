#ifndef DUET_CLIENT_CLI_BATCH_REPAIR_H_
#define DUET_CLIENT_CLI_BATCH_REPAIR_H_

#include <filesystem>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/batch/job_folder.h"
#include "client/batch/shard.h"
#include "client/cli/arguments.h"

namespace duet::client::cli {

// Keeps the command that a run was started with in the data set's own folder, and where it was
// started, so that `duet batch verify --repair` can give it again. Errors as of durable_file.h.
absl::Status KeepCommand(const BatchArguments& arguments, const batch::Shard& shard,
                         const batch::JobFolder& folder);

// The command of the last run of the data set that `verify` looks at. Its paths begin at the folder
// that it was started in: EnterFolderOf goes there. FAILED_PRECONDITION where there is none, or
// where its leaders came by a pipe.
absl::StatusOr<BatchArguments> CommandOf(const BatchArguments& verify);
absl::Status EnterFolderOf(const std::filesystem::path& out);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_REPAIR_H_
