// duet-load: puts a load on a Duet server and measures how fast it answers.
#include <atomic>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "client/cli/stop_signals.h"
#include "contrib/load/program/load_program.h"
#include "model/base/program_output.h"

int main(int argc, char** argv) {
  // What goes wrong is in the statuses that are counted.
  setenv("GRPC_VERBOSITY", "NONE", 0);
  std::atomic<bool> stopped{false};
  const duet::client::cli::StopSignals signals([&stopped] { stopped = true; });
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const int code = duet::contrib::load::program::RunLoadProgram(
      arguments, {&std::cout, &std::cerr, [&stopped] { return stopped.load(); }});
  return duet::base::FinishOutput("duet-load", code);
}
