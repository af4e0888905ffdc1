#ifndef DUET_CLIENT_CLI_ADMIN_FLAGS_H_
#define DUET_CLIENT_CLI_ADMIN_FLAGS_H_

#include "CLI/CLI.hpp"
#include "client/cli/arguments.h"

namespace duet::client::cli {

// duet admin and its commands.
void AddAdminCommand(CLI::App* app, AdminArguments* arguments);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_ADMIN_FLAGS_H_
