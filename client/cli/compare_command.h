#ifndef DUET_CLIENT_CLI_COMPARE_COMMAND_H_
#define DUET_CLIENT_CLI_COMPARE_COMMAND_H_

#include "CLI/CLI.hpp"
#include "client/cli/command.h"

namespace duet::client::cli {

// duet compare: how two motions differ, as text, JSON or a page.
Command AddCompareCommand(CLI::App* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_COMPARE_COMMAND_H_
