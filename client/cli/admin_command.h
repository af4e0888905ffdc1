#ifndef DUET_CLIENT_CLI_ADMIN_COMMAND_H_
#define DUET_CLIENT_CLI_ADMIN_COMMAND_H_

#include "absl/status/statusor.h"
#include "client/cli/arguments.h"
#include "client/cli/exit_code.h"
#include "client/cli/program.h"

namespace duet::client::cli {

// duet admin: does one thing and prints what came of it. A reload after which not everything is as
// the server's configuration has it exits with kExitRetry.
absl::StatusOr<ExitCode> RunAdmin(const AdminArguments& arguments,
                                  const ProgramEnvironment& environment);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_ADMIN_COMMAND_H_
