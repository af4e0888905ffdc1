#ifndef DUET_CLIENT_CLI_PROGRAM_H_
#define DUET_CLIENT_CLI_PROGRAM_H_

#include <string>
#include <vector>

#include "client/cli/program_environment.h"

namespace duet::client::cli {

// Runs the whole `duet` program: parses, calls, writes and prints. Returns its exit code
// (client/cli/exit_code.h). `arguments` come without the program's name.
int RunProgram(const std::vector<std::string>& arguments, const ProgramEnvironment& environment);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_PROGRAM_H_
