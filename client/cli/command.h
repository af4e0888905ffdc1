#ifndef DUET_CLIENT_CLI_COMMAND_H_
#define DUET_CLIENT_CLI_COMMAND_H_

#include <CLI/CLI.hpp>
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/report.h"
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

// A command of the program.
struct Command {
  CLI::App* app = nullptr;  // its name, help and flags
  // Runs after its flags were parsed. The program reports the error, if any.
  std::function<absl::StatusOr<ExitCode>(const ProgramEnvironment&)> run;
  // The servers that it calls, for error messages.
  std::function<std::string()> servers = [] { return std::string(); };
};

// The exit code of a command that either succeeds or fails with `status`.
inline absl::StatusOr<ExitCode> Done(const absl::Status& status) {
  if (!status.ok()) return status;
  return kExitDone;
}
inline absl::StatusOr<ExitCode> Done(absl::StatusOr<ExitCode> code) { return code; }

// A command that runs `run` with the arguments that `app` fills in. `run` returns a status, or a
// status or an exit code.
template <typename Arguments, typename Result>
Command MakeCommand(CLI::App* app, std::shared_ptr<Arguments> arguments,
                    Result (*run)(const Arguments&, const ProgramEnvironment&)) {
  Command command;
  command.app = app;
  command.run = [arguments = std::move(arguments), run](const ProgramEnvironment& environment) {
    return Done(run(*arguments, environment));
  };
  return command;
}

// The same for a command that calls the server `arguments->server`.
template <typename Arguments, typename Result>
Command MakeServerCommand(CLI::App* app, const std::shared_ptr<Arguments>& arguments,
                          Result (*run)(const Arguments&, const ProgramEnvironment&)) {
  Command command = MakeCommand(app, arguments, run);
  command.servers = [arguments] { return arguments->server.address; };
  return command;
}

// Each adds a command to the program; its file, such as view_command.cc, has all of it.
Command AddModelsCommand(CLI::App* program);
Command AddSynthesizeCommand(CLI::App* program);
Command AddLiveCommand(CLI::App* program);
Command AddBatchCommand(CLI::App* program);
Command AddInspectCommand(CLI::App* program);
Command AddConvertCommand(CLI::App* program);
Command AddViewCommand(CLI::App* program);
Command AddAdminCommand(CLI::App* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_COMMAND_H_
