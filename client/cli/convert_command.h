#ifndef DUET_CLIENT_CLI_CONVERT_COMMAND_H_
#define DUET_CLIENT_CLI_CONVERT_COMMAND_H_

#include "CLI/CLI.hpp"
#include "client/cli/command.h"

namespace duet::client::cli {

// duet convert: writes a motion in other formats, without a server. Reads back what it wrote, and
// reports what the format could not hold.
Command AddConvertCommand(CLI::App* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_CONVERT_COMMAND_H_
