#ifndef DUET_CLIENT_CLI_VIEW_COMMAND_H_
#define DUET_CLIENT_CLI_VIEW_COMMAND_H_

#include "absl/status/status.h"
#include "client/cli/arguments.h"
#include "client/cli/program.h"

namespace duet::client::cli {

// duet view: motions side by side on one page.
absl::Status RunView(const ViewArguments& arguments, const ProgramEnvironment& environment);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_VIEW_COMMAND_H_
