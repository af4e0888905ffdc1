#ifndef DUET_CLIENT_CLI_ADMIN_COMMAND_H_
#define DUET_CLIENT_CLI_ADMIN_COMMAND_H_

#include "client/cli/command.h"
#include "client/cli/flag_set.h"

namespace duet::client::cli {

// duet admin: one action on a running server, whose result it prints. After a reload that could not
// apply the whole configuration, the exit code is kExitRetry.
Command AddAdminCommand(FlagSet* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_ADMIN_COMMAND_H_
