#ifndef DUET_CLIENT_CLI_COMMANDS_H_
#define DUET_CLIENT_CLI_COMMANDS_H_

#include <vector>

#include "client/cli/command.h"
#include "client/cli/flag_set.h"

namespace duet::client::cli {

// Adds every command to the program, in the order in which help lists them.
std::vector<Command> AddCommands(FlagSet* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_COMMANDS_H_
