#ifndef DUET_CLIENT_CLI_COMPARE_COMMAND_H_
#define DUET_CLIENT_CLI_COMPARE_COMMAND_H_

#include "absl/status/status.h"
#include "client/cli/arguments.h"
#include "client/cli/program.h"

namespace duet::client::cli {

// duet compare: how two motions differ, as text, JSON or a page.
absl::Status RunCompare(const CompareArguments& arguments, const ProgramEnvironment& environment);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_COMPARE_COMMAND_H_
