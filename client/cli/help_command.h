#ifndef DUET_CLIENT_CLI_HELP_COMMAND_H_
#define DUET_CLIENT_CLI_HELP_COMMAND_H_

#include "CLI/CLI.hpp"
#include "client/cli/command.h"

namespace duet::client::cli {

// duet help: explains the program, a command or a topic.
Command AddHelpCommand(CLI::App* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_HELP_COMMAND_H_
