#ifndef DUET_CLIENT_CLI_MOTION_FLAGS_H_
#define DUET_CLIENT_CLI_MOTION_FLAGS_H_

#include "CLI/CLI.hpp"
#include "client/cli/arguments.h"

// The commands that need no server: motion files are looked at, converted, shown and compared.

namespace duet::client::cli {

CLI::App* AddInspectCommand(CLI::App* app, InspectArguments* arguments);
CLI::App* AddConvertCommand(CLI::App* app, ConvertArguments* arguments);
CLI::App* AddViewCommand(CLI::App* app, ViewArguments* arguments);
CLI::App* AddCompareCommand(CLI::App* app, CompareArguments* arguments);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_MOTION_FLAGS_H_
