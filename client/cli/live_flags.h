#ifndef DUET_CLIENT_CLI_LIVE_FLAGS_H_
#define DUET_CLIENT_CLI_LIVE_FLAGS_H_

#include "client/cli/flag_set.h"
#include "client/cli/live_arguments.h"

namespace duet::client::cli {

void AddLiveFlags(FlagSet* command, LiveArguments* arguments);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_LIVE_FLAGS_H_
