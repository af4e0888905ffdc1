// duet: the command-line client of a Duet server.
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "client/cli/command.h"
#include "model/base/program_output.h"

int main(int argc, char** argv) {
  // Errors are in the status of a call. gRPC's own log lines would repeat them, and also appear
  // without an error, for example for a proxy without a health service.
  setenv("GRPC_VERBOSITY", "NONE", 0);
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const int code = duet::client::cli::RunProgram(
      arguments, {duet::client::Client::Create, &std::cout, &std::cerr, STDIN_FILENO,
                  isatty(STDERR_FILENO) == 1});
  return duet::base::FinishOutput("duet", code);
}
