#ifndef DUET_CLIENT_CLI_BATCH_COMMAND_H_
#define DUET_CLIENT_CLI_BATCH_COMMAND_H_

#include "client/cli/command.h"
#include "client/cli/flag_set.h"

namespace duet::client::cli {

// duet batch: turns many leaders and a recipe into a data set.
Command AddBatchCommand(FlagSet* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_COMMAND_H_
