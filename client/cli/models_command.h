#ifndef DUET_CLIENT_CLI_MODELS_COMMAND_H_
#define DUET_CLIENT_CLI_MODELS_COMMAND_H_

#include "client/cli/command.h"
#include "client/cli/flag_set.h"

namespace duet::client::cli {

// duet models: prints the models that a server serves.
Command AddModelsCommand(FlagSet* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_MODELS_COMMAND_H_
