#ifndef DUET_CLIENT_CLI_SYNTHESIZE_COMMAND_H_
#define DUET_CLIENT_CLI_SYNTHESIZE_COMMAND_H_

#include "client/cli/command.h"
#include "client/cli/flag_set.h"

namespace duet::client::cli {

// duet synthesize: reads the leader in the joints of the model, calls, and writes every output.
Command AddSynthesizeCommand(FlagSet* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SYNTHESIZE_COMMAND_H_
