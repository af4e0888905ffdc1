#ifndef DUET_CLIENT_CLI_PROGRAM_ENVIRONMENT_H_
#define DUET_CLIENT_CLI_PROGRAM_ENVIRONMENT_H_

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/client.h"

namespace duet::client::cli {

// How the program reaches servers, and where it reads and prints; tests replace it.
struct ProgramEnvironment {
  std::function<absl::StatusOr<Client>(const ClientOptions&)> connect;
  std::ostream* out;
  std::ostream* err;
  int in_descriptor = 0;         // what `-` reads
  bool err_is_terminal = false;  // then progress is updated in place
};

// Runs the whole `duet` program: parses, calls, writes and prints. Returns its exit code
// (report.h). `arguments` come without the program's name.
int RunProgram(const std::vector<std::string>& arguments, const ProgramEnvironment& environment);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_PROGRAM_ENVIRONMENT_H_
