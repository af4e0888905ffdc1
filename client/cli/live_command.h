#ifndef DUET_CLIENT_CLI_LIVE_COMMAND_H_
#define DUET_CLIENT_CLI_LIVE_COMMAND_H_

#include "CLI/CLI.hpp"
#include "client/cli/command.h"

namespace duet::client::cli {

// duet live: the follower of a leader who still moves.
Command AddLiveCommand(CLI::App* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_LIVE_COMMAND_H_
