#ifndef DUET_CLIENT_CLI_SYNTHESIZE_COMMAND_H_
#define DUET_CLIENT_CLI_SYNTHESIZE_COMMAND_H_

#include "absl/status/status.h"
#include "client/cli/arguments.h"
#include "client/cli/program.h"

namespace duet::client::cli {

// duet synthesize: reads the leader in the joints of the model, calls, writes every output.
absl::Status RunSynthesize(const SynthesizeArguments& arguments,
                           const ProgramEnvironment& environment);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SYNTHESIZE_COMMAND_H_
