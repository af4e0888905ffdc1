#ifndef DUET_CLIENT_CLI_BATCH_COMMAND_H_
#define DUET_CLIENT_CLI_BATCH_COMMAND_H_

#include "absl/status/statusor.h"
#include "client/cli/arguments.h"
#include "client/cli/exit_code.h"
#include "client/cli/program.h"

namespace duet::client::cli {

// duet batch, duet batch merge, duet batch verify: the exit code, or why nothing could be done.
absl::StatusOr<ExitCode> RunBatch(const BatchArguments& arguments,
                                  const ProgramEnvironment& environment);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_COMMAND_H_
