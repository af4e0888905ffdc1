#ifndef DUET_CLIENT_CLI_VIEW_COMMAND_H_
#define DUET_CLIENT_CLI_VIEW_COMMAND_H_

#include "client/cli/command.h"
#include "client/cli/flag_set.h"

namespace duet::client::cli {

// duet view: motions side by side on one page.
Command AddViewCommand(FlagSet* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_VIEW_COMMAND_H_
