#ifndef DUET_CLIENT_CLI_INSPECT_COMMAND_H_
#define DUET_CLIENT_CLI_INSPECT_COMMAND_H_

#include "client/cli/command.h"
#include "client/cli/flag_set.h"

namespace duet::client::cli {

// duet inspect: prints what motion files contain and how Duet reads them, and checks each skeleton.
// A file that cannot be read does not stop the others; the worst file decides the exit code.
Command AddInspectCommand(FlagSet* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_INSPECT_COMMAND_H_
