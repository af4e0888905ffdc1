#ifndef DUET_CLIENT_CLI_HELP_COMMAND_H_
#define DUET_CLIENT_CLI_HELP_COMMAND_H_

#include "client/cli/command.h"
#include "client/cli/flag_set.h"

namespace duet::client::cli {

// duet help: explains the program, a command or a topic.
Command AddHelpCommand(FlagSet* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_HELP_COMMAND_H_
