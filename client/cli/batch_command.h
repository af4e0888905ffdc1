#ifndef DUET_CLIENT_CLI_BATCH_COMMAND_H_
#define DUET_CLIENT_CLI_BATCH_COMMAND_H_

#include "CLI/CLI.hpp"
#include "client/cli/command.h"

namespace duet::client::cli {

// duet batch, duet batch merge and duet batch verify.
Command AddBatchCommand(CLI::App* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_COMMAND_H_
