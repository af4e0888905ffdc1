#ifndef DUET_CLIENT_CLI_LIVE_COMMAND_H_
#define DUET_CLIENT_CLI_LIVE_COMMAND_H_

#include "client/cli/command.h"
#include "client/cli/flag_set.h"

namespace duet::client::cli {

// duet live: the follower of a leader who still moves.
Command AddLiveCommand(FlagSet* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_LIVE_COMMAND_H_
