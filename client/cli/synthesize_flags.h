#ifndef DUET_CLIENT_CLI_SYNTHESIZE_FLAGS_H_
#define DUET_CLIENT_CLI_SYNTHESIZE_FLAGS_H_

#include "client/cli/flag_set.h"
#include "client/cli/synthesize_arguments.h"

namespace duet::client::cli {

// Adds the flags of duet synthesize to its command. `arguments` outlives the command.
void AddSynthesizeFlags(FlagSet* command, SynthesizeArguments* arguments);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SYNTHESIZE_FLAGS_H_
