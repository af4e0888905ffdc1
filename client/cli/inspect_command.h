#ifndef DUET_CLIENT_CLI_INSPECT_COMMAND_H_
#define DUET_CLIENT_CLI_INSPECT_COMMAND_H_

#include "client/cli/arguments.h"
#include "client/cli/exit_code.h"
#include "client/cli/program.h"

namespace duet::client::cli {

// duet inspect: what is in motion files and how they are understood, with a check of each body.
// A file that cannot be read does not keep the others from being looked at; it decides the exit
// code.
ExitCode RunInspect(const InspectArguments& arguments, const ProgramEnvironment& environment);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_INSPECT_COMMAND_H_
