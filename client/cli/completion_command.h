#ifndef DUET_CLIENT_CLI_COMPLETION_COMMAND_H_
#define DUET_CLIENT_CLI_COMPLETION_COMMAND_H_

#include "client/cli/command.h"
#include "client/cli/flag_set.h"

namespace duet::client::cli {

// duet completion: prints a completion script for a shell.
Command AddCompletionCommand(FlagSet* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_COMPLETION_COMMAND_H_
