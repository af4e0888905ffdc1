// duet-load: puts a load on a Duet server and measures how fast it answers.
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "contrib/load/load_program.h"
#include "model/base/program_output.h"

namespace {

volatile std::sig_atomic_t stopped = 0;

// The first signal ends the run with its report, the second one the process.
void StopAtSignal(int signal) {
  stopped = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

int main(int argc, char** argv) {
  // What goes wrong is in the statuses that are counted.
  setenv("GRPC_VERBOSITY", "NONE", 0);
  std::signal(SIGINT, StopAtSignal);
  std::signal(SIGTERM, StopAtSignal);
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const int code = duet::contrib::load::RunLoadProgram(
      arguments, {&std::cout, &std::cerr, [] { return stopped != 0; }});
  return duet::base::FinishOutput("duet-load", code);
}
