#ifndef DUET_CLIENT_CLI_SYNTHESIZE_COMMAND_H_
#define DUET_CLIENT_CLI_SYNTHESIZE_COMMAND_H_

#include "CLI/CLI.hpp"
#include "client/cli/command.h"

namespace duet::client::cli {

// duet synthesize: reads the leader in the joints of the model, calls, and writes every output.
Command AddSynthesizeCommand(CLI::App* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SYNTHESIZE_COMMAND_H_
