#ifndef DUET_CLIENT_CLI_MODELS_COMMAND_H_
#define DUET_CLIENT_CLI_MODELS_COMMAND_H_

#include "absl/status/status.h"
#include "client/cli/arguments.h"
#include "client/cli/program.h"

namespace duet::client::cli {

// duet models: prints what the server answers with.
absl::Status RunModels(const ModelsArguments& arguments, const ProgramEnvironment& environment);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_MODELS_COMMAND_H_
