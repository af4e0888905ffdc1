#ifndef DUET_CLIENT_CLI_COMPARE_COMMAND_H_
#define DUET_CLIENT_CLI_COMPARE_COMMAND_H_

#include "client/cli/command.h"
#include "client/cli/flag_set.h"

namespace duet::client::cli {

// duet compare: how two motions differ, as text, JSON or a page.
Command AddCompareCommand(FlagSet* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_COMPARE_COMMAND_H_
