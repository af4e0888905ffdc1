// duet: the command-line client of a Duet server.
#include <unistd.h>

#include <iostream>

#include "client/cli/program.h"

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  return duet::client::cli::RunProgram(
      arguments, {duet::client::Client::Create, &std::cout, &std::cerr, &std::cin,
                  isatty(STDERR_FILENO) == 1});
}
