#ifndef DUET_CLIENT_CLI_CONVERT_COMMAND_H_
#define DUET_CLIENT_CLI_CONVERT_COMMAND_H_

#include "absl/status/status.h"
#include "client/cli/arguments.h"
#include "client/cli/program.h"

namespace duet::client::cli {

// duet convert: a motion from one format to others, without a server. What is written is read back,
// so that what a format cannot hold is told rather than promised.
absl::Status RunConvert(const ConvertArguments& arguments, const ProgramEnvironment& environment);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_CONVERT_COMMAND_H_
