#ifndef DUET_CLIENT_CLI_LIVE_FLAGS_H_
#define DUET_CLIENT_CLI_LIVE_FLAGS_H_

#include "CLI/CLI.hpp"
#include "client/cli/live_arguments.h"

namespace duet::client::cli {

void AddLiveFlags(CLI::App* command, LiveArguments* arguments);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_LIVE_FLAGS_H_
