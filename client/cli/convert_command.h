#ifndef DUET_CLIENT_CLI_CONVERT_COMMAND_H_
#define DUET_CLIENT_CLI_CONVERT_COMMAND_H_

#include "client/cli/command.h"
#include "client/cli/flag_set.h"

namespace duet::client::cli {

// duet convert: writes a motion in other formats, without a server. Reads back what it wrote, and
// reports what the format could not hold.
Command AddConvertCommand(FlagSet* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_CONVERT_COMMAND_H_
