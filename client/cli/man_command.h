#ifndef DUET_CLIENT_CLI_MAN_COMMAND_H_
#define DUET_CLIENT_CLI_MAN_COMMAND_H_

#include "client/cli/command.h"
#include "client/cli/flag_set.h"

namespace duet::client::cli {

// duet man: prints a manual page, or writes all of them into a folder.
Command AddManCommand(FlagSet* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_MAN_COMMAND_H_
